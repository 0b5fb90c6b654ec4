// SPDX-License-Identifier: GPL-2.0-or-later
// What `vkpt export` wrote, read as another renderer would: nothing of the module's is used.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace vkpt::truth {

using glm::dvec2;
using glm::dvec3;

struct Picture {
    int width = 0, height = 0;
    std::vector<dvec3> texels; // linear
};

struct Material {
    dvec3 tint { 1 }, emission_tint { 0 };
    dvec3 base_colour { 1 }, emission { 0 }; // where there is no picture
    double roughness = 1, metallic = 0, specular = 1;
    bool is_sky = false, is_translucent = false;
    int picture = -1; // index into ExportedScene::pictures
};

struct Triangle {
    std::array<dvec3, 3> positions, normals;
    std::array<dvec2, 3> uvs; // v grows downwards
    uint32_t material = 0;
    uint32_t ray_mask = 0;
    int emitter = -1; // -1: none; -2: shines for who sees it alone
};

enum class EmitterType { triangle, sphere, sky };

struct Emitter {
    EmitterType type = EmitterType::triangle;
    std::array<dvec3, 3> corners; // of triangles
    dvec3 centre { 0 }; // of spheres
    double radius = 0;
    dvec3 radiance { 0 }; // of skies: the average
    double area = 0;
};

struct Sky {
    dvec3 radiance { 0 };
    glm::dmat3 rotation { 1 };
    Picture picture; // equirectangular, none: empty
};

struct Camera {
    dvec3 position { 0 }, forward { 0 }, right { 0 }, up { 0 };
    int width = 0, height = 0;
};

struct RayMasks {
    uint32_t opaque = 0, alpha_test = 0, own_body = 0, sky = 0, translucent = 0, view_weapon = 0;
};

struct ExportedScene {
    std::vector<Triangle> triangles;
    std::vector<Material> materials;
    std::vector<Emitter> emitters; // dark ones, too
    std::vector<Picture> pictures;
    Sky sky;
    Camera camera;
    RayMasks masks;
};

// Throws std::runtime_error or a JSON error where something is missing.
ExportedScene read_exported_scene(const std::filesystem::path& folder);

} // namespace vkpt::truth
