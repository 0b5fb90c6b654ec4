// SPDX-License-Identifier: GPL-2.0-or-later
// The interface: a panel at the right, labels over the picture, the help.
#pragma once

#include "client/view/state.hpp"

namespace vkpt::client::view {

// Inside of a Dear ImGui frame.
void draw_panel(State& state, glm::vec2 window); // panel.cpp
// Passes, errors and the marked pixel's lights below the picture; 0 high where the window is low: then the panel has
// them.
float dock_height(const State& state, glm::vec2 window);
void draw_dock(State& state, glm::vec2 window);
void draw_overlay(const State& state, glm::vec2 window); // overlay.cpp: labels, divider, mark, notice
void draw_help(State& state, glm::vec2 window); // overlay.cpp
void draw_loading(const State& state, glm::vec2 window); // overlay.cpp: before the first picture

// Sections of the panel.
void draw_settings(State& state); // panel_settings.cpp
void draw_passes(const State& state); // panel_graphs.cpp
void draw_errors(State& state); // panel_graphs.cpp
void draw_marked_surface(const State& state); // panel_inspection.cpp
void draw_marked_lights(const State& state);

} // namespace vkpt::client::view
