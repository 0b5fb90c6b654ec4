// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/truth/exported_scene.hpp"

#include "client/analysis/linear_image.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace vkpt::truth {

namespace {

using Json = nlohmann::json;

dvec3 read_vector(const Json& json) { return { json.at(0), json.at(1), json.at(2) }; }

std::ifstream open(const std::filesystem::path& path)
{
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error("cannot read " + path.string());
    return file;
}

Picture read_picture(const std::filesystem::path& path)
{
    const analysis::LinearImage image = analysis::read_image(path);
    Picture picture { image.width, image.height, {} };
    for (size_t i = 0; i < image.pixel_count(); i++)
        picture.texels.emplace_back(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]);
    return picture;
}

Emitter read_emitter(const Json& json)
{
    Emitter emitter;
    const std::string type = json.at("type");
    emitter.type = type == "sphere" ? EmitterType::sphere : type == "sky" ? EmitterType::sky : EmitterType::triangle;
    if (emitter.type == EmitterType::sphere) {
        emitter.centre = read_vector(json.at("centre"));
        emitter.radius = json.at("radius");
    } else {
        for (size_t corner = 0; corner < 3; corner++)
            emitter.corners[corner] = read_vector(json.at("vertices").at(corner));
    }
    if (type == "sun" || json.contains("cone"))
        throw std::runtime_error("suns and spots are not modelled");
    if (json.contains("reach"))
        throw std::runtime_error("lights that end at a distance are not modelled");
    emitter.radiance = read_vector(json.at("radiance"));
    emitter.area = json.at("area");
    return emitter;
}

Material read_material(const Json& json)
{
    Material material;
    material.tint = read_vector(json.at("tint"));
    material.base_colour = read_vector(json.at("base_colour"));
    material.emission_tint = read_vector(json.at("emission_tint"));
    material.emission = read_vector(json.at("emission"));
    material.roughness = json.at("roughness");
    material.metallic = json.at("metallic");
    material.specular = json.at("specular");
    for (const std::string flag : json.at("flags")) {
        material.is_sky |= flag == "sky";
        material.is_translucent |= flag == "translucent";
    }
    return material;
}

// The pictures that scene.mtl names, by material.
void read_pictures(const std::filesystem::path& folder, ExportedScene& scene)
{
    std::ifstream file = open(folder / "scene.mtl");
    std::map<std::string, int> known;
    size_t material = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word, value;
        words >> word >> value;
        if (word == "newmtl")
            material = std::stoul(value.substr(value.rfind('_') + 1));
        if (word != "map_Kd")
            continue;
        const auto [entry, is_new] = known.emplace(value, int(scene.pictures.size()));
        if (is_new)
            scene.pictures.push_back(read_picture(folder / value));
        scene.materials.at(material).picture = entry->second;
    }
}

// The writer gives each corner a vertex of its own, in the triangles' order.
void read_triangles(const std::filesystem::path& folder, const Json& json, ExportedScene& scene)
{
    scene.triangles.resize(json.at("triangles"));
    for (size_t i = 0; i < scene.triangles.size(); i++) {
        scene.triangles[i].emitter = json.at("triangle_emitters").at(i);
        scene.triangles[i].ray_mask = json.at("triangle_ray_masks").at(i);
    }
    std::ifstream file = open(folder / "scene.obj");
    size_t positions = 0, uvs = 0, normals = 0;
    uint32_t material = 0;
    const auto corner = [&](auto member, size_t& count) -> auto&
    {
        const size_t i = count++;
        return (scene.triangles.at(i / 3).*member)[i % 3];
    };
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            dvec3& p = corner(&Triangle::positions, positions);
            words >> p.x >> p.y >> p.z;
        } else if (word == "vn") {
            dvec3& n = corner(&Triangle::normals, normals);
            words >> n.x >> n.y >> n.z;
        } else if (word == "vt") {
            dvec2& uv = corner(&Triangle::uvs, uvs);
            words >> uv.x >> uv.y;
            uv.y = 1 - uv.y;
        } else if (word == "usemtl") {
            words >> word;
            material = uint32_t(std::stoul(word.substr(word.rfind('_') + 1)));
        } else if (word == "f") {
            size_t first = 0;
            words >> first;
            scene.triangles.at((first - 1) / 3).material = material;
        }
    }
}

} // namespace

ExportedScene read_exported_scene(const std::filesystem::path& folder)
{
    std::ifstream file = open(folder / "scene.json");
    const Json json = Json::parse(file);
    ExportedScene scene;
    for (const Json& emitter : json.at("emitters"))
        scene.emitters.push_back(read_emitter(emitter));
    for (const Json& material : json.at("materials"))
        scene.materials.push_back(read_material(material));
    read_pictures(folder, scene);
    read_triangles(folder, json, scene);

    const Json& sky = json.at("sky");
    scene.sky.radiance = read_vector(sky.at("radiance"));
    if (sky.contains("file")) {
        scene.sky.picture = read_picture(folder / std::string(sky.at("file")));
        for (int axis = 0; axis < 3; axis++)
            scene.sky.rotation[axis] = read_vector(sky.at("rotation").at(size_t(axis)));
    }
    const Json& camera = json.at("camera");
    scene.camera = { read_vector(camera.at("position")), read_vector(camera.at("forward")),
        read_vector(camera.at("right")), read_vector(camera.at("up")), camera.at("width"), camera.at("height") };
    const Json& masks = json.at("ray_masks");
    scene.masks = { masks.at("opaque"), masks.at("alpha_test"), masks.at("own_body"), masks.at("sky"),
        masks.at("translucent"), masks.at("view_weapon") };
    return scene;
}

} // namespace vkpt::truth
