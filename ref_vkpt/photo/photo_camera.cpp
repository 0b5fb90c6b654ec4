// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/photo/photo_camera.hpp"

#include "common/numbers.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "ref_vkpt/scene/projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>

namespace vkpt {

namespace {

constexpr float min_fov = 2, max_fov_in_perspective = 160, max_pitch = 90, max_stops = 8;
constexpr float max_coordinate = 65536; // far outside of any map

constexpr size_t max_numbers = 3;
using Numbers = std::array<float, max_numbers>; // those that are not given: 0

glm::vec3 to_vec3(const Numbers& n) { return { n[0], n[1], n[2] }; }

void keep_in_limits(PhotoCamera& camera)
{
    camera.eye = glm::clamp(camera.eye, glm::vec3(-max_coordinate), glm::vec3(max_coordinate));
    camera.angles.x = std::clamp(camera.angles.x, -max_pitch, max_pitch);
    camera.angles.y = std::remainder(camera.angles.y, 360.0f);
    camera.angles.z = std::remainder(camera.angles.z, 360.0f);
    const bool is_perspective = camera.projection == shared::PROJECTION_PERSPECTIVE;
    camera.fov = std::clamp(camera.fov, min_fov, is_perspective ? max_fov_in_perspective : max_fov(camera.projection));
    camera.exposure = std::clamp(camera.exposure, -max_stops, max_stops);
}

// Forward, to the right, up.
void move_by(PhotoCamera& camera, glm::vec3 way)
{
    const Axes axes = angle_vectors(camera.angles);
    camera.eye += axes.forward * way.x + axes.right * way.y + axes.up * way.z;
}

// As a lens of so many times the focal length.
void zoom_by(PhotoCamera& camera, float factor)
{
    const float width = plane_half_width(camera.projection, camera.fov) / factor;
    camera.fov = fov_of_half_width(camera.projection, width);
}

struct Word {
    std::string_view word;
    size_t min_numbers, max_numbers;
    void (*obey)(PhotoCamera& camera, const Numbers& numbers);
};
constexpr Word words[] = {
    { "at", 3, 3, [](PhotoCamera& camera, const Numbers& n) { camera.eye = to_vec3(n); } },
    { "look", 2, 3, [](PhotoCamera& camera, const Numbers& n) { camera.angles = to_vec3(n); } },
    { "move", 1, 3, [](PhotoCamera& camera, const Numbers& n) { move_by(camera, to_vec3(n)); } },
    { "turn", 2, 3, [](PhotoCamera& camera, const Numbers& n) { camera.angles += to_vec3(n); } },
    { "fov", 1, 1, [](PhotoCamera& camera, const Numbers& n) { camera.fov = n[0]; } },
    { "zoom", 1, 1, [](PhotoCamera& camera, const Numbers& n) { zoom_by(camera, std::clamp(n[0], 0.01f, 100.0f)); } },
    { "exposure", 1, 1, [](PhotoCamera& camera, const Numbers& n) { camera.exposure = n[0]; } },
};
constexpr std::string_view descriptions[] = {
    "at X Y Z: puts the camera there",
    "look PITCH YAW [ROLL]: turns it to these angles, in degrees",
    "move FORWARD [RIGHT [UP]]: moves it by so many units",
    "turn PITCH YAW [ROLL]: turns it by so many degrees; down, left, left are positive",
    "fov DEGREES: angle of sight from left to right",
    "zoom FACTOR: 2 shows things twice as large, 0.5 half",
    "exposure STOPS: brighter or darker",
};
static_assert(std::size(words) == std::size(descriptions));

bool is_held(const PhotoInput& input, PhotoKey key) { return input.held[size_t(key)]; }

// 1, -1 or 0.
float balance(const PhotoInput& input, PhotoKey more, PhotoKey less)
{
    return float(is_held(input, more)) - float(is_held(input, less));
}

} // namespace

PhotoCamera camera_of(const engine::RefDef& refdef)
{
    PhotoCamera camera;
    for (int i = 0; i < 3; i++) {
        camera.eye[i] = refdef.view_origin[i];
        camera.angles[i] = refdef.view_angles[i];
    }
    camera.fov = refdef.fov_x;
    return camera;
}

PhotoCamera with_projection(PhotoCamera camera, int projection)
{
    camera.projection = projection;
    keep_in_limits(camera);
    return camera;
}

std::string obey_words(PhotoCamera& camera, std::string_view word, std::span<const std::string_view> given)
{
    const auto* known = std::ranges::find(words, word, &Word::word);
    if (known == std::end(words))
        return fmt::format("there is no \"{}\"", word);
    const std::string_view usage = descriptions[known - words];
    if (given.size() < known->min_numbers || given.size() > known->max_numbers)
        return fmt::format("usage: pt_photo {}", usage);
    Numbers numbers {};
    for (size_t i = 0; i < given.size(); i++) {
        const auto number = parse_number<Numbers::value_type>(given[i]);
        if (!number)
            return fmt::format("\"{}\" is no number; usage: pt_photo {}", given[i], usage);
        numbers[i] = *number;
    }
    known->obey(camera, numbers);
    keep_in_limits(camera);
    return {};
}

std::span<const std::string_view> describe_words() { return descriptions; }

bool obey_input(PhotoCamera& camera, const PhotoInput& input, float seconds)
{
    constexpr float units_per_second = 160, fast = 4, roll_per_second = 30, degrees_per_pixel = 0.08f;
    constexpr float zoom_per_notch = 1.1f;
    const PhotoCamera before = camera;
    const float pace = (is_held(input, PhotoKey::fast) ? fast : 1) / (is_held(input, PhotoKey::slow) ? fast : 1);
    const glm::vec3 way(balance(input, PhotoKey::forward, PhotoKey::back),
        balance(input, PhotoKey::right, PhotoKey::left), balance(input, PhotoKey::up, PhotoKey::down));
    if (way != glm::vec3(0))
        move_by(camera, glm::normalize(way) * (units_per_second * pace * seconds));
    camera.angles.z += balance(input, PhotoKey::roll_left, PhotoKey::roll_right) * roll_per_second * pace * seconds;
    // The image follows the mouse alike, however near the lens brings it.
    const float per_pixel = degrees_per_pixel * std::min(plane_half_width(camera.projection, camera.fov), 1.0f);
    camera.angles.x += input.mouse.y * per_pixel;
    camera.angles.y -= input.mouse.x * per_pixel;
    zoom_by(camera, std::pow(zoom_per_notch, std::clamp(input.wheel, -20.0f, 20.0f)));
    if (camera == before)
        return false;
    keep_in_limits(camera);
    return true;
}

void set_fov(engine::RefDef& refdef, float fov_x, float width, float height)
{
    constexpr int perspective = shared::PROJECTION_PERSPECTIVE;
    refdef.fov_x = fov_x;
    refdef.fov_y = fov_of_half_width(perspective, plane_half_width(perspective, fov_x) * height / width);
}

} // namespace vkpt
