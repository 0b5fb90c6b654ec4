// SPDX-License-Identifier: GPL-2.0-or-later
// Every live setting of the chosen side: lists and short ranges first, then the numbers.
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr float label_width = 178;

void draw_choice(State& state, const LiveSetting& setting, const std::string& value)
{
    if (!ImGui::BeginCombo("##value", value.c_str()))
        return;
    for (const std::string& choice : setting.choices) {
        const bool is_missing
            = setting.name == "pt_trace" && choice != "auto" && !std::ranges::count(state.facts.backends, choice);
        if (ImGui::Selectable(choice.c_str(), choice == value, is_missing ? ImGuiSelectableFlags_Disabled : 0))
            set_value(state, state.active, setting.name, choice);
    }
    ImGui::EndCombo();
}

void draw_integer(State& state, const LiveSetting& setting, const std::string& value)
{
    int number = std::atoi(value.c_str());
    if (setting.highest - setting.lowest == 1) {
        bool is_on = number > setting.lowest;
        if (ImGui::Checkbox("##value", &is_on))
            set_value(state, state.active, setting.name, fmt::format("{}", setting.lowest + is_on));
    } else if (ImGui::SliderInt(
                   "##value", &number, int(setting.lowest), int(setting.highest), "%d", ImGuiSliderFlags_AlwaysClamp)) {
        set_value(state, state.active, setting.name, fmt::format("{}", number));
    }
}

void draw_number(State& state, const LiveSetting& setting, const std::string& value)
{
    float number = std::strtof(value.c_str(), nullptr);
    const float speed = std::max(std::abs(number), float(setting.highest - setting.lowest) * 1e-3f) * 0.01f;
    if (ImGui::DragFloat("##value", &number, std::min(speed, 1.0f), float(setting.lowest), float(setting.highest),
            "%.4g", ImGuiSliderFlags_AlwaysClamp))
        set_value(state, state.active, setting.name, fmt::format("{:.5g}", number));
}

ImU32 label_colour(const State& state, const LiveSetting& setting, const std::string& value)
{
    const Side other = state.active == Side::a ? Side::b : Side::a;
    if (state.split.is_on && value != value_of(state, other, setting.name))
        return state.active == Side::a ? colour_a : colour_b;
    return value == setting.initial ? colour_dim : colour_text;
}

void draw_setting(State& state, size_t number)
{
    const LiveSetting& setting = state.live[number];
    const std::string value = value_of(state, state.active, setting.name);
    ImGui::PushID(int(number));
    if (state.highlighted == number) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(
            { corner.x - 6, corner.y + 3 }, { corner.x - 3, corner.y + ImGui::GetFrameHeight() - 3 }, colour_text);
    }
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, label_colour(state, setting, value));
    ImGui::TextUnformatted(setting.name.c_str());
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(360);
        ImGui::TextUnformatted(setting.help.c_str());
        ImGui::Text("Default: %s", setting.initial.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
    if (setting.kind == SettingKind::choice)
        draw_choice(state, setting, value);
    else if (setting.kind == SettingKind::integer)
        draw_integer(state, setting, value);
    else
        draw_number(state, setting, value);
    ImGui::PopID();
}

void draw_side_button(State& state, Side side, const char* label, ImU32 colour)
{
    const bool is_active = state.active == side;
    ImGui::PushStyleColor(ImGuiCol_Button, is_active ? colour : ImGui::GetColorU32(ImGuiCol_Button));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colour);
    ImGui::PushStyleColor(ImGuiCol_Text, is_active ? IM_COL32(10, 10, 10, 255) : colour_text);
    if (ImGui::Button(label, { 64, 0 })) {
        state.active = side;
        state.split.is_on |= side == Side::b;
    }
    ImGui::PopStyleColor(3);
    ImGui::SameLine();
}

} // namespace

void draw_settings(State& state)
{
    draw_side_button(state, Side::a, "A", colour_a);
    draw_side_button(state, Side::b, "B", colour_b);
    if (ImGui::Checkbox("split (X)", &state.split.is_on))
        state.active = state.split.is_on ? Side::b : Side::a;
    ImGui::Spacing();
    for (size_t i = 0; i < state.live.size(); i++)
        if (state.live[i].is_short())
            draw_setting(state, i);
    const bool is_highlighted = state.highlighted < state.live.size() && !state.live[state.highlighted].is_short();
    if (is_highlighted)
        ImGui::SetNextItemOpen(true);
    if (!ImGui::TreeNodeEx("Numbers", ImGuiTreeNodeFlags_NoTreePushOnOpen))
        return;
    for (size_t i = 0; i < state.live.size(); i++)
        if (!state.live[i].is_short())
            draw_setting(state, i);
}

} // namespace vkpt::client::view
