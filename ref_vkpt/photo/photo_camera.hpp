// SPDX-License-Identifier: GPL-2.0-or-later
// The free camera of photo mode: where it is, and what words and keys make of it.
#pragma once

#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/overlay/key_filter.hpp"

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>

namespace vkpt {

struct PhotoCamera {
    glm::vec3 eye { 0 };
    glm::vec3 angles { 0 }; // pitch, yaw, roll in degrees, as the engine's
    float fov = 90; // from left to right, in degrees
    float exposure = 0; // stops, beside pt_exposure_bias
    bool operator==(const PhotoCamera&) const = default;
};

PhotoCamera camera_of(const engine::RefDef& refdef);

// "move 10 0 0" and the like: `numbers` are what follows `word`. What is wrong with it; empty: it was done.
std::string obey_words(PhotoCamera& camera, std::string_view word, std::span<const std::string_view> numbers);
// The words that it knows, with what they take, a line each.
std::span<const std::string_view> describe_words();

// Keys that are held, the mouse and its wheel, over `seconds`. Whether anything has changed.
bool obey_input(PhotoCamera& camera, const PhotoInput& input, float seconds);

// Horizontal and vertical angles of sight in degrees, for an image of such a shape.
void set_fov(engine::RefDef& refdef, float fov_x, float width, float height);

} // namespace vkpt
