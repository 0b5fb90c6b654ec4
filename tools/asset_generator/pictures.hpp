// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D pictures of HUD and menus, as drawings. Identity: dark plates with cut corners, teal lines, amber for what is
// alive.
#pragma once

#include "tools/asset_generator/canvas.hpp"

#include <functional>
#include <string>
#include <vector>

namespace vkpt::tools {

struct Picture {
    std::string name; // below pics/
    int width, height;
    std::function<void(Canvas&)> draw;
    int detail = 4; // samples per pixel and axis; the PNG twin has that size
    float dither = 0.25f;
};

namespace ink {
inline constexpr glm::vec3 plate { 0.055f, 0.08f, 0.105f }, plate_light { 0.10f, 0.145f, 0.18f };
inline constexpr glm::vec3 teal { 0.20f, 0.66f, 0.70f }, teal_dim { 0.10f, 0.32f, 0.37f };
inline constexpr glm::vec3 amber { 1.0f, 0.66f, 0.18f }, ember { 0.96f, 0.30f, 0.14f };
inline constexpr glm::vec3 pale { 0.86f, 0.93f, 0.95f }, grey { 0.52f, 0.58f, 0.62f };
inline constexpr glm::vec3 green { 0.40f, 0.90f, 0.44f }, blue { 0.36f, 0.58f, 1.0f }, violet { 0.80f, 0.46f, 1.0f };
}

// A plate with a lit rim filling `low`..`high`.
void draw_plate(Canvas& canvas, glm::vec2 low, glm::vec2 high, float cut, glm::vec3 rim);
void draw_text(Canvas& canvas, std::string_view text, glm::vec2 top_left, float height, float weight, glm::vec3 top,
    glm::vec3 bottom);
// Draws centred on x; returns the width.
float draw_centred(Canvas& canvas, std::string_view text, float centre_x, float top, float height, float weight,
    glm::vec3 top_ink, glm::vec3 bottom_ink);
// The emblem: a path of light through a box, from lamp to eye.
void draw_emblem(Canvas& canvas, glm::vec2 centre, float radius);

std::vector<Picture> hud_pictures();
std::vector<Picture> icon_pictures();
std::vector<Picture> menu_pictures();

} // namespace vkpt::tools
