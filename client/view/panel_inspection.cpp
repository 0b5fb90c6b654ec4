// SPDX-License-Identifier: GPL-2.0-or-later
// The marked pixel: its surface, and the lights of its cluster with their probabilities.
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr size_t max_rows = 200;

const char* name_of_type(uint32_t type)
{
    switch (type) {
    case shared::EMITTER_TRIANGLE:
        return "face";
    case shared::EMITTER_SPHERE:
        return "sphere";
    case shared::EMITTER_SKY:
        return "sky";
    case shared::EMITTER_TRANSPARENT:
        return "veil";
    case shared::EMITTER_SUN:
        return "sun";
    }
    return "?";
}

void draw_row(const char* name, const std::string& value)
{
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(110);
    ImGui::TextUnformatted(value.c_str());
}

std::string show_vector(const glm::vec3& v, const char* format)
{
    return fmt::format(fmt::runtime(fmt::format("{0}  {0}  {0}", format)), v[0], v[1], v[2]);
}

void draw_surface(const InspectedSurface& s)
{
    draw_row("position", show_vector(s.position, "{:.1f}"));
    draw_row("normal", show_vector(s.normal, "{:.3f}"));
    draw_row("distance", fmt::format("{:.1f}", s.depth));
    draw_row("albedo", show_vector(s.albedo, "{:.3f}"));
    const ImVec2 corner = ImGui::GetItemRectMax();
    const ImVec4 colour(s.albedo[0], s.albedo[1], s.albedo[2], 1);
    ImGui::GetWindowDrawList()->AddRectFilled(
        { corner.x + 10, corner.y - 14 }, { corner.x + 34, corner.y - 2 }, ImGui::GetColorU32(colour));
    draw_row("material", fmt::format("roughness {:.2f}  metalness {:.2f}", s.roughness, s.metallic));
    draw_row("emitted", show_vector(s.emitted, "{:.3f}"));
    draw_row("cluster", fmt::format("{}", s.cluster));
}

// Probability as a bar behind its figure.
void draw_probability(double probability, double most, ImU32 colour)
{
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x * float(most > 0 ? std::min(probability / most, 1.0) : 0);
    ImGui::GetWindowDrawList()->AddRectFilled(
        corner, { corner.x + width, corner.y + ImGui::GetTextLineHeight() }, (colour & 0x00ffffffu) | 0x60000000u);
    ImGui::Text("%6.2f %%", 100 * probability);
}

void draw_light(const InspectedLight& light, uint32_t choices, double most, ImU32 colour)
{
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::Text("%u %s", light.emitter, name_of_type(light.type));
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("centre %s\nradiance %s\narea %.1f  lightstyle %u",
            show_vector(light.centre, "{:.1f}").c_str(), show_vector(light.radiance, "{:.3f}").c_str(),
            double(light.area), light.lightstyle);
    ImGui::TableNextColumn();
    ImGui::Text("%.3g", double(light.weight));
    ImGui::TableNextColumn();
    draw_probability(light.probability, most, colour);
    ImGui::TableNextColumn();
    ImGui::Text("%6.2f %%", choices > 0 ? 100.0 * light.picked / choices : 0.0);
}

void draw_lights(const Inspection& inspection, ImU32 colour)
{
    double sum = 0;
    for (const InspectedLight& light : inspection.lights)
        sum += light.probability;
    ImGui::Text("%u lights, sampler %s", inspection.surface.light_count, inspection.sampler.c_str());
    ImGui::TextDisabled("probabilities sum to %.1f %%", 100 * sum);
    constexpr ImGuiTableFlags flags
        = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp;
    if (!ImGui::BeginTable("lights", 4, flags, { 0, std::max(ImGui::GetContentRegionAvail().y - 4, 180.0f) }))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* column : { "light", "weight", "probability", "picked" })
        ImGui::TableSetupColumn(column);
    ImGui::TableHeadersRow();
    const double most = inspection.lights.empty() ? 0 : inspection.lights.front().probability;
    for (size_t i = 0; i < std::min(inspection.lights.size(), max_rows); i++)
        draw_light(inspection.lights[i], inspection.surface.choices, most, colour);
    ImGui::EndTable();
    if (inspection.lights.size() > max_rows)
        ImGui::TextDisabled("and %zu less probable ones", inspection.lights.size() - max_rows);
}

} // namespace

void draw_marked_surface(const State& state)
{
    if (!state.inspection) {
        ImGui::TextDisabled("Click the picture, or press P.");
        return;
    }
    const Inspection& inspection = *state.inspection;
    ImGui::PushStyleColor(ImGuiCol_Text, state.inspected_side == Side::a ? colour_a : colour_b);
    ImGui::Text("%s  (%d, %d)", state.inspected_side == Side::a ? "A" : "B", inspection.pixel.x, inspection.pixel.y);
    ImGui::PopStyleColor();
    if (inspection.surface.depth >= 0) {
        draw_surface(inspection.surface);
        return;
    }
    ImGui::SameLine();
    ImGui::TextUnformatted("sky, or an unlit texture");
    draw_row("emitted", show_vector(inspection.surface.emitted, "{:.3f}"));
}

void draw_marked_lights(const State& state)
{
    if (!state.inspection || state.inspection->surface.depth < 0)
        ImGui::TextDisabled("Lights of a marked pixel");
    else
        draw_lights(*state.inspection, state.inspected_side == Side::a ? colour_a : colour_b);
}

} // namespace vkpt::client::view
