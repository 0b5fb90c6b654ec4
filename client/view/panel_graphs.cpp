// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr float graph_height = 84;

struct GraphArea {
    ImVec2 corner;
    ImVec2 size;
};

GraphArea begin_graph()
{
    const GraphArea area { ImGui::GetCursorScreenPos(), { ImGui::GetContentRegionAvail().x, graph_height } };
    ImGui::GetWindowDrawList()->AddRectFilled(area.corner, { area.corner.x + area.size.x, area.corner.y + area.size.y },
        ImGui::GetColorU32(ImGuiCol_FrameBg));
    ImGui::Dummy(area.size);
    return area;
}

void write_scale(const GraphArea& area, const std::string& top)
{
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 size = ImGui::CalcTextSize(top.c_str());
    list->AddRectFilled(area.corner, { area.corner.x + size.x + 8, area.corner.y + size.y + 2 }, colour_plate);
    list->AddText({ area.corner.x + 4, area.corner.y + 1 }, colour_text, top.c_str());
}

void draw_stack(const PassHistory& history, const std::vector<std::string>& names)
{
    const GraphArea area = begin_graph();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const double top = history.scale();
    const float column = std::floor(area.size.x / float(kept_frames));
    const float first = area.corner.x + area.size.x - column * float(history.size());
    for (size_t frame = 0; frame < history.size(); frame++) {
        const float x = first + column * float(frame);
        double below = 0;
        for (size_t n = 0; n < names.size(); n++) {
            const double above = std::min(below + history.milliseconds(frame, names[n]), top);
            const float y0 = area.corner.y + area.size.y * float(1 - above / top),
                        y1 = area.corner.y + area.size.y * float(1 - below / top);
            if (std::lround(y1) > std::lround(y0))
                list->AddRectFilled({ x, std::round(y0) }, { x + column, std::round(y1) }, series_colour(n));
            below = above;
        }
    }
    write_scale(area, fmt::format("{:g} ms", top));
}

void draw_pass_row(const PassHistory& history, const std::string& name, size_t number, double total)
{
    const double median = history.median(name);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled(
        { corner.x, corner.y + 3 }, { corner.x + height - 6, corner.y + height - 3 }, series_colour(number));
    ImGui::Dummy({ height, height });
    ImGui::SameLine();
    const std::string figures = fmt::format("{:.2f} ms  {:3.0f} %", median, total > 0 ? 100 * median / total : 0);
    const float figures_width = ImGui::CalcTextSize(figures.c_str()).x, width = ImGui::GetContentRegionAvail().x;
    const ImVec2 text = ImGui::GetCursorScreenPos();
    ImGui::PushClipRect(text, { text.x + width - figures_width - 4, text.y + height }, true); // long names are cut
    ImGui::TextUnformatted(name.c_str());
    ImGui::PopClipRect();
    ImGui::SameLine(ImGui::GetContentRegionMax().x - figures_width);
    ImGui::TextUnformatted(figures.c_str());
}

void draw_side_passes(const SideState& side)
{
    const std::vector<std::string> names = side.passes.names();
    if (names.empty()) {
        ImGui::TextDisabled("no frame yet");
        return;
    }
    draw_stack(side.passes, names);
    double total = 0;
    for (const std::string& name : names)
        total += side.passes.median(name);
    for (size_t n = 0; n < names.size(); n++)
        draw_pass_row(side.passes, names[n], n, total);
    const std::string sum = fmt::format("{:.2f} ms on the device", total);
    ImGui::TextDisabled("medians of %zu frames", side.passes.size());
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(sum.c_str()).x);
    ImGui::TextUnformatted(sum.c_str());
}

// RMSE over the last frames of both sides, logarithmically: a decade to four.
void draw_error_graph(const State& state)
{
    double lowest = 1e30, highest = 1e-30;
    for (const SideState& side : state.sides)
        for (const analysis::ImageError& error : side.errors.figures) {
            lowest = std::min(lowest, std::max(error.rmse, 1e-6));
            highest = std::max(highest, error.rmse);
        }
    if (highest < lowest)
        return;
    const double top = std::ceil(std::log10(highest)), bottom = std::min(std::floor(std::log10(lowest)), top - 1);
    const GraphArea area = begin_graph();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float column = std::floor(area.size.x / float(kept_frames));
    for (size_t s = 0; s < state.sides.size(); s++) {
        const auto& figures = state.sides[s].errors.figures;
        for (size_t i = 0; i < figures.size(); i++) {
            const double height = (std::log10(std::max(figures[i].rmse, 1e-6)) - bottom) / (top - bottom);
            const float x = area.corner.x + area.size.x - column * float(figures.size() - i),
                        y = area.corner.y + area.size.y * float(1 - height);
            list->AddRectFilled({ x, y - 1 }, { x + column, y + 2 }, s == 0 ? colour_a : colour_b);
        }
    }
    write_scale(area, fmt::format("{:g} RMSE; bottom {:g}", std::pow(10, top), std::pow(10, bottom)));
}

void draw_error_row(const State& state, Side which)
{
    const SideState& side = state.side(which);
    ImGui::PushStyleColor(ImGuiCol_Text, which == Side::a ? colour_a : colour_b);
    ImGui::TextUnformatted(which == Side::a ? "A" : "B");
    ImGui::PopStyleColor();
    ImGui::SameLine();
    if (side.errors.figures.empty()) {
        ImGui::TextDisabled("not measured yet");
        return;
    }
    const analysis::ImageError& error = side.errors.figures.back();
    ImGui::Text("RMSE %.4g   relative MSE %.4g", error.rmse, error.relative_mse);
}

bool are_of_one_size(const State& state)
{
    return std::ranges::all_of(state.live, [&](const LiveSetting& setting) {
        return !setting.help.starts_with("Render size")
            || value_of(state, Side::a, setting.name) == value_of(state, Side::b, setting.name);
    });
}

} // namespace

void draw_passes(const State& state) { draw_side_passes(state.side(state.active)); }

void draw_errors(State& state)
{
    if (ImGui::Checkbox("measure against a reference (M)", &state.has_reference)) {
        state.reference_frames = 0;
        for (SideState& side : state.sides)
            side.errors = {};
    }
    if (!state.has_reference)
        return;
    if (state.split.is_on && !are_of_one_size(state))
        ImGui::TextWrapped("A and B are rendered at different sizes: B's error means nothing.");
    ImGui::Text("reference: %u frames", state.reference_frames);
    if (state.reference_rmse) {
        ImGui::SameLine();
        ImGui::Text("itself off by %.4g", *state.reference_rmse);
    }
    draw_error_row(state, Side::a);
    if (state.split.is_on)
        draw_error_row(state, Side::b);
    draw_error_graph(state);
}

} // namespace vkpt::client::view
