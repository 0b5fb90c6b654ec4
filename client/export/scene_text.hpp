// SPDX-License-Identifier: GPL-2.0-or-later
// A scene as files that other renderers read. Quake world units, z up, right-handed; linear RGB.
#pragma once

#include "client/export/scene_pictures.hpp"
#include "ref_vkpt/extension.hpp"

#include <string>
#include <vector>

namespace vkpt::client {

// A scene whose materials are all different. The strings are the original's.
struct MergedScene {
    explicit MergedScene(const SceneContents& scene);
    MergedScene(const MergedScene&) = delete; // `contents` points into it
    MergedScene& operator=(const MergedScene&) = delete;
    std::vector<SceneTriangle> triangles;
    std::vector<SceneMaterial> materials;
    SceneContents contents; // of the above, and the rest of the original
};

// Triangles with normals and picture coordinates (v grows upwards, as in OBJ), grouped by material; `materials_file`
// stands beside it. Materials are named material_N. The corners of triangle t are the vertices 3 t + 1, + 2, + 3.
std::string make_obj(const SceneContents& scene, const std::string& materials_file);
// With a picture: Kd and map_Kd, Ke and map_Ke are to be multiplied; without: Kd the average colour, Ke the average
// radiance. d; Pr, Pm: roughness and metalness (the PBR extension of the format).
std::string make_mtl(const SceneContents& scene, const ScenePictures& pictures);
// Camera, sky, triangles' emitters and ray masks, every emitter with its radiance and power, materials, liquids, and
// the sums. `sky_file`: the picture beside it, empty: none.
std::string make_scene_json(
    const SceneContents& scene, const std::string& name, int frame, ImageSize size, const std::string& sky_file);

inline constexpr int scene_schema = 2;

} // namespace vkpt::client
