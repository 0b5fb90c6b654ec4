// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/export/scene_text.hpp"

#include "shaders/shared/scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* emitter_types[] = { "triangle", "sphere", "sky", "veil" }; // by EMITTER_*
constexpr std::pair<uint32_t, const char*> material_flags[] = { { shared::MATERIAL_SKY, "sky" },
    { shared::MATERIAL_WARP, "warp" }, { shared::MATERIAL_TRANSLUCENT, "translucent" },
    { shared::MATERIAL_ALPHA_TEST, "alpha_test" }, { shared::MATERIAL_FULLBRIGHT, "fullbright" } };

Json vector_of(const float (&v)[3]) { return { v[0], v[1], v[2] }; }

Json flags_of(uint32_t flags)
{
    Json names = Json::array();
    for (const auto& [flag, name] : material_flags)
        if (flags & flag)
            names.push_back(name);
    return names;
}

// Shines evenly to all sides of its front: pi * area * radiance.
double power_of(const SceneEmitter& emitter, size_t channel)
{
    return std::numbers::pi * double(emitter.area) * double(emitter.radiance[channel]);
}

Json make_emitter(const SceneEmitter& emitter)
{
    const bool is_sphere = emitter.type == shared::EMITTER_SPHERE;
    Json json { { "type", emitter.type < std::size(emitter_types) ? emitter_types[emitter.type] : "unknown" } };
    if (is_sphere) {
        json["centre"] = vector_of(emitter.centre);
        json["radius"] = emitter.radius;
    } else {
        json["vertices"]
            = { vector_of(emitter.positions[0]), vector_of(emitter.positions[1]), vector_of(emitter.positions[2]) };
    }
    json["radiance"] = vector_of(emitter.radiance);
    json["area"] = emitter.area;
    json["power"] = { power_of(emitter, 0), power_of(emitter, 1), power_of(emitter, 2) };
    if (emitter.reach > 0)
        json["reach"] = emitter.reach;
    return json;
}

Json make_material(const SceneMaterial& material)
{
    return { { "picture", material.picture }, { "base_colour", vector_of(material.base_colour) },
        { "opacity", material.opacity }, { "emission", vector_of(material.emission) },
        { "roughness", material.roughness }, { "metallic", material.metallic }, { "flags", flags_of(material.flags) } };
}

Json make_camera(const SceneCamera& camera, ImageSize size)
{
    const auto degrees = [](const float(&axis)[3]) {
        return 2 * std::atan(std::hypot(axis[0], axis[1], axis[2])) * 180 / std::numbers::pi_v<float>;
    };
    return { { "position", vector_of(camera.eye) }, { "forward", vector_of(camera.forward) },
        { "right", vector_of(camera.right) }, { "up", vector_of(camera.up) }, { "fov_x", degrees(camera.right) },
        { "fov_y", degrees(camera.up) }, { "width", size.width }, { "height", size.height } };
}

} // namespace

std::string make_obj(const SceneContents& scene, const std::string& materials_file)
{
    std::string text = fmt::format(
        "# vkpt export: {} triangles, Quake units, z up\nmtllib {}\n", scene.triangle_count, materials_file);
    const std::span<const SceneTriangle> triangles(scene.triangles, scene.triangle_count);
    std::vector<uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return triangles[i].material; });
    for (const SceneTriangle& triangle : triangles)
        for (size_t corner = 0; corner < 3; corner++) {
            const float* p = triangle.positions[corner];
            fmt::format_to(std::back_inserter(text), "v {} {} {}\n", p[0], p[1], p[2]);
        }
    for (const SceneTriangle& triangle : triangles)
        for (const auto& uv : triangle.uvs)
            fmt::format_to(std::back_inserter(text), "vt {} {}\n", uv[0], 1 - uv[1]);
    uint32_t material = UINT32_MAX;
    for (const uint32_t i : order) {
        if (triangles[i].material != material) {
            material = triangles[i].material;
            fmt::format_to(std::back_inserter(text), "usemtl material_{}\n", material);
        }
        const size_t first = 3 * size_t(i) + 1; // indices count from 1
        fmt::format_to(std::back_inserter(text), "f {0}/{0} {1}/{1} {2}/{2}\n", first, first + 1, first + 2);
    }
    return text;
}

std::string make_mtl(const SceneContents& scene)
{
    std::string text = "# vkpt export: linear colours; Ke is radiance\n";
    for (size_t i = 0; i < scene.material_count; i++) {
        const SceneMaterial& m = scene.materials[i];
        fmt::format_to(std::back_inserter(text),
            "newmtl material_{}\n# {}\nKd {} {} {}\nKe {} {} {}\nd {}\nPr {}\nPm {}\n", i,
            *m.picture ? m.picture : "no picture", m.base_colour[0], m.base_colour[1], m.base_colour[2], m.emission[0],
            m.emission[1], m.emission[2], m.opacity, m.roughness, m.metallic);
    }
    return text;
}

std::string make_scene_json(const SceneContents& scene, const std::string& name, int frame, ImageSize size)
{
    Json json { { "schema", scene_schema }, { "scene", name }, { "frame", frame },
        { "space", "Quake units, z up, right-handed" },
        { "radiance", "linear RGB; a white diffuse surface under a lightmap value of 128 has 1" },
        { "camera", make_camera(scene.camera, size) }, { "triangles", scene.triangle_count } };
    double power[3] = {};
    json["emitters"] = json["materials"] = Json::array();
    for (size_t i = 0; i < scene.emitter_count; i++) {
        json["emitters"].push_back(make_emitter(scene.emitters[i]));
        for (size_t c = 0; c < 3; c++)
            power[c] += power_of(scene.emitters[i], c);
    }
    for (size_t i = 0; i < scene.material_count; i++)
        json["materials"].push_back(make_material(scene.materials[i]));
    json["emitter_count"] = scene.emitter_count;
    json["emitted_power"] = { power[0], power[1], power[2] };
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace vkpt::client
