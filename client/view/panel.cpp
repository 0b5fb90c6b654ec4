// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/actions.hpp"
#include "client/view/panels.hpp"
#include "client/view/theme.hpp"

#include <fmt/format.h>

namespace vkpt::client::view {

namespace {

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove
    | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

void draw_heading(const State& state)
{
    ImGui::TextUnformatted(state.scene.c_str());
    const std::string device = fmt::format("{}, rays: {}", state.facts.device, state.sides[0].backend);
    ImGui::PushStyleColor(ImGuiCol_Text, colour_dim);
    ImGui::TextWrapped("%s", device.c_str());
    ImGui::PopStyleColor();
}

void draw_time(State& state)
{
    if (ImGui::Button(state.plays ? "Pause" : "Play", { 64, 0 }))
        state.plays = !state.plays;
    ImGui::SameLine();
    if (state.is_endless()) {
        ImGui::AlignTextToFramePadding();
        ImGui::Text(
            "%.2f s%s", state.frame / 60.0, state.plays && !does_time_pass(state) ? "  (stopped while averaging)" : "");
        return;
    }
    int frame = state.frame;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 0, state.last_frame(), "frame %d")) {
        state.plays = false;
        show_frame(state, frame);
    }
}

void draw_camera(State& state)
{
    const Camera& camera = state.camera;
    const std::string place = fmt::format("@{:.0f},{:.0f},{:.0f},{:.0f},{:.0f}", camera.position.x, camera.position.y,
        camera.position.z, camera.pitch, camera.yaw);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(place.c_str());
    ImGui::SameLine();
    if (ImGui::SmallButton("Copy")) {
        ImGui::SetClipboardText((state.is_endless() ? state.scene + place : place).c_str());
        show_notice(state, "copied: use it as SCENE of vkpt render and vkpt view");
    }
    if (state.has_flown) {
        ImGui::SameLine();
        if (ImGui::SmallButton("Home"))
            state.has_flown = false;
    }
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat("##speed", &state.speed, slowest_speed, fastest_speed, "fly %.0f units per second",
        ImGuiSliderFlags_Logarithmic);
}

void draw_buttons(State& state)
{
    if (ImGui::Button("Save picture (O)"))
        save_picture(state);
    ImGui::SameLine();
    if (ImGui::Button("Help (F1)"))
        state.shows_help = !state.shows_help;
}

bool begin_section(const char* title, bool is_open)
{
    ImGui::Spacing();
    return ImGui::CollapsingHeader(title, is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void draw_console(const State& state)
{
    ImGui::PushStyleColor(ImGuiCol_Text, colour_dim);
    for (const std::string& line : state.console)
        ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
}

} // namespace

float dock_height(const State& state, glm::vec2 window)
{
    constexpr float height = 262, min_window = 700, min_width = 1180;
    return state.shows_panel && window.y >= min_window && window.x >= min_width ? height : 0;
}

void draw_dock(State& state, glm::vec2 window)
{
    const float height = dock_height(state, window);
    ImGui::SetNextWindowPos({ 0, window.y - height });
    ImGui::SetNextWindowSize({ window.x - panel_width, height });
    if (ImGui::Begin("dock", nullptr, fixed)) {
        constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX;
        if (ImGui::BeginTable("columns", 3, flags)) {
            ImGui::TableSetupColumn("passes", ImGuiTableColumnFlags_WidthStretch, 0.30f);
            ImGui::TableSetupColumn("error", ImGuiTableColumnFlags_WidthStretch, 0.29f);
            ImGui::TableSetupColumn("lights", ImGuiTableColumnFlags_WidthStretch, 0.41f);
            ImGui::TableNextColumn();
            draw_passes(state);
            ImGui::TableNextColumn();
            draw_errors(state);
            ImGui::TableNextColumn();
            draw_marked_lights(state);
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

void draw_panel(State& state, glm::vec2 window)
{
    ImGui::SetNextWindowPos({ window.x - panel_width, 0 });
    ImGui::SetNextWindowSize({ panel_width, window.y });
    if (ImGui::Begin("panel", nullptr, fixed)) {
        draw_heading(state);
        draw_time(state);
        draw_camera(state);
        draw_buttons(state);
        if (begin_section("Settings", true))
            draw_settings(state);
        const bool has_dock = dock_height(state, window) > 0;
        if (!has_dock && begin_section("Passes", true))
            draw_passes(state);
        if (!has_dock && begin_section("Error", true))
            draw_errors(state);
        if (begin_section("Marked pixel", true)) {
            draw_marked_surface(state);
            if (!has_dock)
                draw_marked_lights(state);
        }
        if (begin_section("Messages", false))
            draw_console(state);
    }
    ImGui::End();
}

} // namespace vkpt::client::view
