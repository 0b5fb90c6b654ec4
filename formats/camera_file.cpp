// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/camera_file.hpp"

#include "common/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

namespace formats {

namespace {

constexpr float farthest = 65536; // from the origin
constexpr float narrowest = 5, widest = 150; // degrees

std::string_view trim(std::string_view text)
{
    constexpr std::string_view space = " \t\r";
    const size_t first = std::min(text.find_first_not_of(space), text.size());
    text.remove_prefix(first);
    return text.substr(0, text.find_last_not_of(space) + 1);
}

// "(x, y, z)" at the front of the text, which goes on behind it.
std::optional<glm::vec3> take_vector(std::string_view& text)
{
    text = trim(text);
    const size_t end = text.find(')');
    if (text.empty() || text.front() != '(' || end == std::string_view::npos)
        return std::nullopt;
    std::string numbers(text.substr(1, end - 1));
    if (std::ranges::count(numbers, ',') != 2)
        return std::nullopt;
    std::ranges::replace(numbers, ',', ' ');
    const auto parts = vkpt::parse_numbers<float, 3>(numbers);
    if (!parts)
        return std::nullopt;
    text.remove_prefix(end + 1);
    return glm::vec3((*parts)[0], (*parts)[1], (*parts)[2]);
}

// What is wrong with the line; "": nothing.
std::string read_line(std::string_view line, SecurityCamera& camera)
{
    const auto eye = take_vector(line), forward = take_vector(line);
    if (!eye || !forward)
        return "a camera is a line such as (0, 0, 128) (1, 0, -0.5)";
    if (!(std::abs(eye->x) <= farthest && std::abs(eye->y) <= farthest && std::abs(eye->z) <= farthest))
        return "the camera is outside of every map";
    const float length = glm::length(*forward);
    if (!(length > 1e-6f && std::isfinite(length)))
        return "the camera looks nowhere: its second vector has no length";
    camera.eye = *eye;
    camera.forward = *forward / length;
    line = trim(line);
    if (line.empty())
        return "";
    const auto degrees = vkpt::parse_number<float>(line);
    if (!degrees || *degrees < narrowest || *degrees > widest)
        return "behind the two vectors there may be an angle of 5 to 150 degrees";
    camera.fov_x = *degrees;
    return "";
}

} // namespace

CameraFile read_cameras(std::string_view text, std::string_view file)
{
    if (text.size() > max_camera_bytes)
        throw FormatError(
            file, max_camera_bytes, "cameras in more than " + std::to_string(max_camera_bytes) + " bytes");
    CameraFile result;
    const auto complain = [&](int line, const std::string& reason) {
        if (result.messages.size() < CameraFile::max_messages)
            result.messages.push_back(std::string(file) + ", line " + std::to_string(line) + ": " + reason);
    };
    for (int number = 1; !text.empty(); number++) {
        const size_t end = std::min(text.find('\n'), text.size());
        const std::string_view whole = text.substr(0, end), line = trim(whole.substr(0, whole.find('#')));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty())
            continue;
        SecurityCamera camera;
        if (const std::string reason = read_line(line, camera); !reason.empty()) {
            complain(number, reason);
            continue;
        }
        if (result.cameras.size() == max_security_cameras) {
            complain(number,
                "this camera and what follows is left out: a map has at most " + std::to_string(max_security_cameras));
            break;
        }
        result.cameras.push_back(camera);
    }
    return result;
}

std::string write_camera(const SecurityCamera& camera)
{
    char line[256];
    std::snprintf(line, sizeof line, "(%.9g, %.9g, %.9g) (%.9g, %.9g, %.9g) %.9g", double(camera.eye.x),
        double(camera.eye.y), double(camera.eye.z), double(camera.forward.x), double(camera.forward.y),
        double(camera.forward.z), double(camera.fov_x));
    return line;
}

} // namespace formats
