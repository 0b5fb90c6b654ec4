// SPDX-License-Identifier: GPL-2.0-or-later
// Text files that say where a map's security cameras are (maps/cameras/NAME.txt), in the format of Q2RTX:
//
//     # a comment
//     (100, -250.5, 64) (0.7, 0.7, -0.1)
//     (0, 0, 128) (1, 0, -0.5) 60
//
// A line for each: where it stands, where it looks, and, which Q2RTX reads over, how many degrees it sees from left to
// right.
#pragma once

#include "formats/byte_reader.hpp"

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace formats {

struct SecurityCamera {
    glm::vec3 eye { 0 };
    glm::vec3 forward { 1, 0, 0 }; // unit
    float fov_x = 90; // degrees
};

struct CameraFile {
    std::vector<SecurityCamera> cameras; // at most max_security_cameras
    std::vector<std::string> messages; // lines that were left out, by file and line; at most so many
    static constexpr size_t max_messages = 16;
};

inline constexpr size_t max_security_cameras = 8;
inline constexpr size_t max_camera_bytes = 64 << 10;

// Never fails on what is in the lines: what makes no sense is left out, with a message. Throws FormatError for larger
// files.
CameraFile read_cameras(std::string_view text, std::string_view file);

// A line that read_cameras reads again, without its end.
std::string write_camera(const SecurityCamera& camera);

} // namespace formats
