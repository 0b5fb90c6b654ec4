// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/actions.hpp"
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"

#include <chrono>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr float margin = 8, padding = 6;
constexpr float notice_seconds = 4;

struct Line {
    std::string text;
    ImU32 colour;
};

float plate_height(size_t lines) { return float(lines) * (ImGui::GetTextLineHeight() + 2) + 2 * padding - 2; }

constexpr float any_width = 1e6f;

// Lines on a dark plate. `right`: the corner is the upper right one. What is wider than `max_width` is cut.
void draw_plate(ImVec2 corner, std::initializer_list<Line> lines, bool right = false, float max_width = any_width)
{
    ImDrawList* list = ImGui::GetBackgroundDrawList(); // behind the help
    const float step = ImGui::GetTextLineHeight() + 2;
    float width = 0;
    for (const Line& line : lines)
        width = std::max(width, ImGui::CalcTextSize(line.text.c_str()).x);
    width = std::min(width, max_width);
    corner = { std::floor(right ? corner.x - width - 2 * padding : corner.x), std::floor(corner.y) };
    const ImVec2 end { corner.x + width + 2 * padding, corner.y + plate_height(lines.size()) };
    list->AddRectFilled(corner, end, colour_plate);
    float y = corner.y + padding;
    list->PushClipRect(corner, end, true);
    for (const Line& line : lines) {
        list->AddText({ corner.x + padding, y }, line.colour, line.text.c_str());
        y += step;
    }
    list->PopClipRect();
}

std::string describe_speed(const SideState& side)
{
    std::string text
        = fmt::format("{:.1f} frames/s  {:.0f} ms", 1000 / std::max(side.milliseconds, 1e-3), side.milliseconds);
    if (side.averaged_frames > 1)
        text += fmt::format("  {} averaged", side.averaged_frames);
    if (!side.errors.figures.empty())
        text += fmt::format("  RMSE {:.4g}", side.errors.figures.back().rmse);
    return text;
}

void draw_side_label(const State& state, Side which)
{
    const SideState& side = state.side(which);
    const bool is_b = which == Side::b;
    // Above the picture where there is room, so that nothing of it is hidden.
    const float above = state.shown.y - plate_height(2) - margin / 2;
    const ImVec2 corner = { is_b ? state.shown.x + state.shown.width - margin : state.shown.x + margin,
        above >= 0 ? above : state.shown.y + margin };
    draw_plate(corner,
        { { fmt::format("{}  {}", is_b ? "B" : "A", describe_side(state, which)), is_b ? colour_b : colour_a },
            { describe_speed(side), colour_text } },
        is_b,
        state.split.is_on ? std::max(state.shown.width / 2 - 2 * (margin + padding), 0.0f)
                          : any_width); // room for the other's
}

void draw_divider(const State& state)
{
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const Area& shown = state.shown;
    const float x = std::round(state.split.divider(shown));
    list->AddRectFilled({ x - 1, shown.y }, { x + 1, shown.y + shown.height }, IM_COL32_WHITE);
    const float middle = std::round(shown.y + shown.height / 2);
    list->AddRectFilled({ x - 5, middle - 22 }, { x + 5, middle + 22 }, IM_COL32_WHITE);
    list->AddRectFilled({ x - 2, middle - 12 }, { x - 1, middle + 12 }, IM_COL32(20, 20, 20, 255));
    list->AddRectFilled({ x + 1, middle - 12 }, { x + 2, middle + 12 }, IM_COL32(20, 20, 20, 255));
}

void draw_mark(const State& state)
{
    const glm::vec2 size(state.picture_size());
    const Area& shown = state.shown;
    const float x = std::round(shown.x + (float(state.marked->x) + 0.5f) * shown.width / size.x),
                y = std::round(shown.y + (float(state.marked->y) + 0.5f) * shown.height / size.y);
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const auto draw = [&](float thickness, ImU32 colour) {
        constexpr float inner = 5, outer = 17;
        const float t = thickness;
        list->AddRectFilled({ x - outer, y - t }, { x - inner, y + t + 1 }, colour);
        list->AddRectFilled({ x + inner + 1, y - t }, { x + outer + 1, y + t + 1 }, colour);
        list->AddRectFilled({ x - t, y - outer }, { x + t + 1, y - inner }, colour);
        list->AddRectFilled({ x - t, y + inner + 1 }, { x + t + 1, y + outer + 1 }, colour);
    };
    draw(3, IM_COL32(0, 0, 0, 255));
    draw(1, state.inspected_side == Side::a ? colour_a : colour_b);
}

void draw_notice(const State& state)
{
    const std::chrono::duration<float> age = Clock::now() - state.notice_time;
    if (state.notice.empty() || age.count() > notice_seconds)
        return;
    const float height = ImGui::GetTextLineHeight() + 2 * padding;
    draw_plate({ state.shown.x + margin, state.shown.y + state.shown.height - height - margin },
        { { state.notice, state.notice_is_bad ? colour_warning : colour_text } });
}

void draw_key_row(const char* keys, const char* help)
{
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, colour_a);
    ImGui::TextUnformatted(keys);
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(help);
}

bool begin_keys(const char* title)
{
    ImGui::Spacing();
    ImGui::TextDisabled("%s", title);
    if (!ImGui::BeginTable(title, 2, ImGuiTableFlags_SizingFixedFit))
        return false;
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 176);
    ImGui::TableSetupColumn("help", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

void draw_move_keys()
{
    if (!begin_keys("Moving"))
        return;
    for (const MoveKey& key : move_keys())
        draw_key_row(key.keys, key.help);
    ImGui::EndTable();
}

// The actions of one group; they stand together in the table.
void draw_group(const char* group)
{
    if (!begin_keys(group))
        return;
    for (const Action& action : actions())
        if (*action.keys && std::strcmp(action.group, group) == 0)
            draw_key_row(action.keys, action.help);
    ImGui::EndTable();
}

} // namespace

void draw_overlay(const State& state, glm::vec2)
{
    if (state.split.is_on)
        draw_divider(state);
    if (state.marked && state.picture_size().x > 0)
        draw_mark(state);
    draw_side_label(state, Side::a);
    if (state.split.is_on)
        draw_side_label(state, Side::b);
    draw_notice(state);
}

void draw_help(State& state, glm::vec2 window)
{
    const float room = state.shows_panel ? window.x - panel_width : window.x;
    const float width = std::min(room - 2 * margin, 940.0f);
    ImGui::SetNextWindowPos({ std::floor(std::max(room - width, 0.0f) / 2), margin }, ImGuiCond_Always);
    ImGui::SetNextWindowSize({ width, std::min(window.y - 2 * margin, 780.0f) });
    constexpr ImGuiWindowFlags fixed
        = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav;
    if (ImGui::Begin("Keys and mouse", &state.shows_help, fixed)) {
        const bool is_wide = width > 760;
        if (is_wide)
            ImGui::Columns(2, nullptr, false);
        draw_move_keys();
        const char* last = nullptr;
        for (const Action& action : actions()) {
            if (last && std::strcmp(last, action.group) == 0)
                continue;
            if (is_wide && last && ImGui::GetColumnIndex() == 0)
                ImGui::NextColumn();
            draw_group(action.group);
            last = action.group;
        }
        if (is_wide)
            ImGui::Columns(1);
    }
    ImGui::End();
}

void draw_loading(const State& state, glm::vec2 window)
{
    const std::string last = state.console.empty() ? std::string("starting the renderer") : state.console.back();
    const bool is_loaded = !state.live.empty();
    draw_plate({ margin * 2, window.y / 2 - 30 },
        { { is_loaded ? std::string("Drawing the first picture: the driver compiles its shaders ...")
                      : fmt::format("Loading {} ...", state.scene),
              colour_text },
            { last, colour_dim } });
}

} // namespace vkpt::client::view
