// SPDX-License-Identifier: GPL-2.0-or-later
// A scene as files that other renderers read. Quake world units, z up, right-handed; linear RGB.
#pragma once

#include "ref_vkpt/extension.hpp"

#include <string>

namespace vkpt::client {

// Triangles with picture coordinates (v grows upwards, as in OBJ), grouped by material; `materials_file` stands beside
// it. Materials are named material_N.
std::string make_obj(const SceneContents& scene, const std::string& materials_file);
// Kd: average colour; Ke: average radiance; d; Pr, Pm: roughness and metalness (the PBR extension of the format).
std::string make_mtl(const SceneContents& scene);
// Camera, every emitter with its radiance and power, materials, and the sums.
std::string make_scene_json(const SceneContents& scene, const std::string& name, int frame, ImageSize size);

inline constexpr int scene_schema = 1;

} // namespace vkpt::client
