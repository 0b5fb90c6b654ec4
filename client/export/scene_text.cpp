// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/export/scene_text.hpp"

#include "shaders/shared/liquid.h"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

namespace vkpt::client {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* emitter_types[] = { "triangle", "sphere", "sky", "veil", "sun" }; // by EMITTER_*
constexpr std::pair<uint32_t, const char*> ray_masks[] = { { shared::MASK_OPAQUE, "opaque" },
    { shared::MASK_TRANSLUCENT, "translucent" }, { shared::MASK_ALPHA_TEST, "alpha_test" },
    { shared::MASK_VIEW_WEAPON, "view_weapon" }, { shared::MASK_OWN_BODY, "own_body" }, { shared::MASK_SKY, "sky" } };
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

bool has_cone(const SceneEmitter& emitter) { return emitter.cone_cosines[0] > emitter.cone_cosines[1]; }

// Shines evenly to all sides of its front, pi * area * radiance, or into its cone.
double power_of(const SceneEmitter& emitter, size_t channel)
{
    const double inner = double(emitter.cone_cosines[0]), outer = double(emitter.cone_cosines[1]);
    const double share = has_cone(emitter) ? 0.5 * (1 - 0.5 * (inner + outer)) : 1;
    return share * std::numbers::pi * double(emitter.area) * double(emitter.radiance[channel]);
}

Json make_emitter(const SceneEmitter& emitter)
{
    const bool is_sphere = emitter.type == shared::EMITTER_SPHERE || emitter.type == shared::EMITTER_SUN;
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
    if (has_cone(emitter))
        json["cone"] = { { "axis", vector_of(emitter.cone_axis) },
            { "cosines", { emitter.cone_cosines[0], emitter.cone_cosines[1] } } };
    return json;
}

Json make_material(const SceneMaterial& material)
{
    return { { "picture", material.texture }, { "tint", vector_of(material.tint) },
        { "base_colour", vector_of(material.base_colour) }, { "opacity", material.opacity },
        { "emission_tint", vector_of(material.emission_tint) }, { "emission", vector_of(material.emission) },
        { "roughness", material.roughness }, { "metallic", material.metallic }, { "specular", material.specular },
        { "uv_scroll", { material.uv_scroll[0], material.uv_scroll[1] } }, { "flags", flags_of(material.flags) } };
}

Json make_sky(const SceneSky& sky, const std::string& file)
{
    Json json { { "radiance", vector_of(sky.radiance) } };
    if (file.empty())
        return json;
    json["file"] = file;
    json["projection"] = "equirectangular: the middle is +x, a quarter to the left +y, the top +z";
    json["rotation"] = { vector_of(sky.rotation[0]), vector_of(sky.rotation[1]), vector_of(sky.rotation[2]) };
    return json;
}

Json make_wave(const glm::vec4& wave, const glm::vec2& direction)
{
    return { { "wave_vector", { wave.x, wave.y } }, { "angular_speed", wave.z },
        { "slope", { wave.w * direction.x, wave.w * direction.y } } };
}

// How surfaces with the flag "warp" look. The slope of water that lies flat: the sum of slope * cos(dot(place,
// wave_vector) + angular_speed * time).
Json make_liquids()
{
    using namespace shared;
    return { { "warp", { { "amplitude", WARP_AMPLITUDE }, { "frequency", WARP_FREQUENCY }, { "speed", WARP_SPEED } } },
        { "water",
            { { "index_of_refraction", WATER_INDEX },
                { "absorption", { WATER_ABSORPTION.x, WATER_ABSORPTION.y, WATER_ABSORPTION.z } },
                { "waves",
                    { make_wave(WATER_WAVE_A, WATER_SLOPE_A), make_wave(WATER_WAVE_B, WATER_SLOPE_B),
                        make_wave(WATER_WAVE_C, WATER_SLOPE_C) } } } } };
}

Json name_masks()
{
    Json json;
    for (const auto& [mask, name] : ray_masks)
        json[name] = mask;
    return json;
}

// What tells materials apart.
auto key_of(const SceneMaterial& m)
{
    const auto numbers = [](const float(&v)[3]) { return std::tuple(v[0], v[1], v[2]); };
    return std::tuple(std::string_view(m.texture), numbers(m.tint), numbers(m.base_colour), m.opacity,
        numbers(m.emission_tint), numbers(m.emission), m.roughness, m.metallic, m.uv_scroll[0], m.uv_scroll[1],
        m.flags);
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

MergedScene::MergedScene(const SceneContents& scene)
    : triangles(scene.triangles, scene.triangles + scene.triangle_count)
    , contents(scene)
{
    std::map<decltype(key_of(*scene.materials)), uint32_t> numbers;
    std::vector<uint32_t> merged;
    for (size_t i = 0; i < scene.material_count; i++) {
        const auto [entry, is_new] = numbers.emplace(key_of(scene.materials[i]), uint32_t(materials.size()));
        if (is_new)
            materials.push_back(scene.materials[i]);
        merged.push_back(entry->second);
    }
    for (SceneTriangle& triangle : triangles)
        triangle.material = merged[triangle.material];
    contents.triangles = triangles.data();
    contents.materials = materials.data();
    contents.material_count = materials.size();
}

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
    for (const SceneTriangle& triangle : triangles)
        for (const auto& n : triangle.normals)
            fmt::format_to(std::back_inserter(text), "vn {} {} {}\n", n[0], n[1], n[2]);
    uint32_t material = UINT32_MAX;
    for (const uint32_t i : order) {
        if (triangles[i].material != material) {
            material = triangles[i].material;
            fmt::format_to(std::back_inserter(text), "usemtl material_{}\n", material);
        }
        const size_t first = 3 * size_t(i) + 1; // indices count from 1
        fmt::format_to(
            std::back_inserter(text), "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", first, first + 1, first + 2);
    }
    return text;
}

std::string make_mtl(const SceneContents& scene, const ScenePictures& pictures)
{
    std::string text = "# vkpt export: linear colours, pictures are sRGB; Ke is radiance\n";
    const auto out = std::back_inserter(text);
    for (size_t i = 0; i < scene.material_count; i++) {
        const SceneMaterial& m = scene.materials[i];
        const std::string file = pictures.name_of(m.texture);
        const auto& colour = file.empty() ? m.base_colour : m.tint;
        const auto& radiance = file.empty() ? m.emission : m.emission_tint;
        fmt::format_to(out, "newmtl material_{}\n# {}\nKd {} {} {}\nKe {} {} {}\nd {}\nPr {}\nPm {}\n", i,
            *m.texture ? m.texture : "no picture", colour[0], colour[1], colour[2], radiance[0], radiance[1],
            radiance[2], m.opacity, m.roughness, m.metallic);
        if (!file.empty())
            fmt::format_to(out, "map_Kd {}\n", file);
        if (!file.empty() && std::ranges::any_of(radiance, [](float x) { return x > 0; }))
            fmt::format_to(out, "map_Ke {}\n", file);
        if (!file.empty() && m.flags & shared::MATERIAL_ALPHA_TEST)
            fmt::format_to(out, "map_d {}\n", file);
    }
    return text;
}

std::string make_scene_json(
    const SceneContents& scene, const std::string& name, int frame, ImageSize size, const std::string& sky_file)
{
    Json json { { "schema", scene_schema }, { "scene", name }, { "frame", frame },
        { "space", "Quake units, z up, right-handed" },
        { "radiance", "linear RGB; a white diffuse surface under a lightmap value of 128 has 1" },
        { "camera", make_camera(scene.camera, size) }, { "pixel_filter", "box, one pixel wide" },
        { "time", scene.time }, { "sky", make_sky(scene.sky, sky_file) }, { "liquids", make_liquids() },
        { "ray_masks", name_masks() }, { "triangles", scene.triangle_count } };
    for (size_t i = 0; i < scene.triangle_count; i++) {
        json["triangle_emitters"].push_back(scene.triangles[i].emitter);
        json["triangle_ray_masks"].push_back(scene.triangles[i].ray_mask);
    }
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
