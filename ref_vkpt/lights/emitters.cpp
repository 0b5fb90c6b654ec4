// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/emitters.hpp"

#include "common/colour.hpp"
#include "ref_vkpt/lights/animated_lights.hpp"
#include "ref_vkpt/lights/cluster_finder.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

namespace vkpt {

namespace {

using formats::Bsp;
using formats::BspTexinfo;

enum class Emission {
    none,
    face, // SURF_LIGHT with a value
    sky,
};

Emission classify(const BspTexinfo& texinfo)
{
    if (texinfo.flags & formats::SURF_SKY) // also where it is SURF_NODRAW: the engine shows the sky there
        return Emission::sky;
    if (texinfo.flags & formats::SURF_NODRAW)
        return Emission::none;
    return (texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0 ? Emission::face : Emission::none;
}

// Rays that bounce see through it or through its holes.
bool is_transparent(const BspTexinfo& texinfo)
{
    return (texinfo.flags & (formats::SURF_TRANS33 | formats::SURF_TRANS66 | formats::SURF_ALPHATEST)) != 0;
}

uint32_t emitter_type(const BspTexinfo& texinfo)
{
    if (classify(texinfo) == Emission::sky)
        return shared::EMITTER_SKY;
    return is_transparent(texinfo) ? shared::EMITTER_TRANSPARENT : shared::EMITTER_TRIANGLE;
}

float max_component(glm::vec3 colour) { return std::max({ colour.x, colour.y, colour.z }); }

// The classic compilers scale the texture's average colour so that its greatest component is 1.
glm::vec3 normalise_colour(glm::vec3 colour)
{
    const float greatest = max_component(colour);
    return greatest > 0 ? colour / greatest : glm::vec3(0);
}

// The classic light compiler counts a missing texture as half as bright as any that is there.
float strength_of(const FaceTexture& texture) { return texture.missing ? 0.5f : 1.0f; }

// What the texture is multiplied by where it shines without the map's light value.
float glow_factor(const FaceTexture& texture, const EmissionScales& scales)
{
    return scales.glow * texture.emissive_factor * texture.default_radiance;
}

glm::vec3 average_radiance(const BspTexinfo& texinfo, const FaceTexture& texture, const EmissionScales& scales)
{
    const glm::vec3 average = glm::max(texture.average, glm::vec3(0));
    if (!texture.takes_light_value)
        return glow_factor(texture, scales) * average;
    if ((texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0)
        return scales.face * float(texinfo.value) * strength_of(texture) * normalise_colour(average)
            * texture.emissive_factor;
    return scales.sky * average;
}

// What the texture is multiplied by, so that the average over it is average_radiance.
glm::vec3 emission_factor(const BspTexinfo& texinfo, const FaceTexture& texture, const EmissionScales& scales)
{
    const bool has_value = has_light_value(texinfo);
    if (is_glowing(texinfo, texture) || (has_value && !texture.takes_light_value))
        return glm::vec3(glow_factor(texture, scales));
    if (!has_value)
        return glm::vec3(0);
    const float greatest = max_component(texture.average);
    return greatest > 0
        ? glm::vec3(scales.face * float(texinfo.value) * strength_of(texture) / greatest) * texture.emissive_factor
        : glm::vec3(0);
}

// Where in the tree a face's front lies: leaves are numbered in tree order, so near numbers are near places.
size_t find_leaf_before(const Bsp& bsp, size_t face)
{
    return bsp.find_leaf(face_centre(bsp, face) + bsp.face_normal(face), find_world_root(bsp));
}

// A face or a point light, to be put in order.
struct Piece {
    size_t leaf;
    int64_t face; // -1: a point light
    std::vector<shared::Emitter> emitters;
};

// A light entity that stands for what glows: right before one of its triangles.
bool has_light_before(const std::vector<shared::Emitter>& face, const std::vector<shared::Emitter>& lights)
{
    constexpr float near = 48; // units
    for (const shared::Emitter& e : face) {
        const glm::vec3 centre = (e.p0 + e.p1 + e.p2) / 3.0f, front = glm::cross(e.p1 - e.p0, e.p2 - e.p0);
        for (const shared::Emitter& light : lights)
            if (glm::distance(light.p0, centre) < near && glm::dot(light.p0 - centre, front) > 0)
                return true;
    }
    return false;
}

std::vector<Piece> collect_faces(
    const EmissionSource& source, FaceTriangles& faces, const std::vector<shared::Emitter>& lights)
{
    constexpr uint64_t comparisons_per_step = 64;
    const Bsp& bsp = source.bsp;
    std::vector<Piece> pieces;
    WorkLimit work = limit_of_pieces(bsp);
    const formats::BspModel& world = bsp.models[0];
    for (size_t face = size_t(world.first_face); face < size_t(world.first_face + world.face_count); face++) {
        const uint32_t texinfo = bsp.faces[face].texinfo;
        std::vector<shared::Emitter> emitters = emitters_of_face(source, face, faces.of(face));
        if (!emitters.empty() && is_glowing(bsp.texinfos[texinfo], source.textures[texinfo])) {
            work.spend(emitters.size() * lights.size() / comparisons_per_step, "face", face);
            if (has_light_before(emitters, lights)) {
                number_emitters(faces.of(face), -1);
                continue;
            }
        }
        if (!emitters.empty())
            pieces.push_back({ find_leaf_before(bsp, face), int64_t(face), std::move(emitters) });
    }
    return pieces;
}

// Names the textures that were meant to emit and do not.
void report_unused(const EmissionSource& source, std::vector<std::string>& messages)
{
    const Bsp& bsp = source.bsp;
    std::map<std::string, size_t> black, undrawn;
    for (const formats::BspFace& face : bsp.faces) {
        const BspTexinfo& texinfo = bsp.texinfos[face.texinfo];
        const bool meant = (texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0;
        if (meant && classify(texinfo) == Emission::none)
            undrawn[texinfo.texture]++;
        else if (meant && !(max_component(source.textures[face.texinfo].average) > 0))
            black[texinfo.texture]++;
    }
    for (const auto& [texture, count] : undrawn)
        messages.push_back(
            fmt::format("{}: {} light faces of {} are not drawn and emit nothing", bsp.name, count, texture));
    for (const auto& [texture, count] : black)
        messages.push_back(
            fmt::format("{}: the texture {} is black: its {} light faces emit nothing", bsp.name, texture, count));
}

} // namespace

bool is_glowing(const BspTexinfo& texinfo, const FaceTexture& texture)
{
    const bool shines_somewhere = !texture.parts.empty() || texture.maps.emissive.slot != 0;
    return texture.glows && shines_somewhere && texinfo.next < 0 && classify(texinfo) == Emission::none
        && !(texinfo.flags & (formats::SURF_NODRAW | formats::SURF_WARP));
}

bool has_light_value(const BspTexinfo& texinfo) { return classify(texinfo) == Emission::face; }

void number_emitters(std::span<FaceTriangle> triangles, int first_emitter)
{
    for (FaceTriangle& triangle : triangles)
        triangle.emitter
            = first_emitter < 0 || triangle.part == FacePiece::dark ? shared::EMITTER_SAMPLED_APART : first_emitter++;
}

namespace {

float area_of(const FaceTriangle& t) { return triangle_area(t.corners[0], t.corners[1], t.corners[2]); }

// What the parts' colours are multiplied by, so that together they send what the whole face would if it had its average
// radiance.
float scale_of_parts(
    std::span<const FaceTriangle> triangles, const std::vector<BrightPart>& parts, glm::vec3 average_radiance)
{
    float of_face = 0, of_parts = 0;
    for (const FaceTriangle& t : triangles) {
        of_face += area_of(t) * luminance(average_radiance);
        if (t.part >= 0)
            of_parts += area_of(t) * luminance(parts[size_t(t.part)].average);
    }
    return of_parts > 0 ? of_face / of_parts : 0;
}

} // namespace

uint32_t face_lightstyle(const formats::BspFace& face, const FaceTexture& texture)
{
    constexpr uint8_t steady = 0, no_lightmap = 255;
    if (!texture.takes_lightstyles)
        return steady;
    for (const uint8_t style : face.styles)
        if (style != steady && style != no_lightmap)
            return style;
    return steady;
}

glm::vec3 frame_radiance(const EmissionSource& source, uint32_t texinfo)
{
    const BspTexinfo& frame = source.bsp.texinfos[texinfo];
    return has_light_value(frame) ? average_radiance(frame, source.textures[texinfo], source.scales) : glm::vec3(0);
}

glm::vec3 face_radiance(const EmissionSource& source, uint32_t texinfo)
{
    glm::vec3 brightest(0);
    for_each_frame(source.bsp, texinfo, [&](uint32_t frame) {
        const glm::vec3 radiance = frame_radiance(source, frame);
        if (luminance(radiance) > luminance(brightest))
            brightest = radiance;
    });
    return brightest;
}

std::vector<shared::Emitter> emitters_of_face(
    const EmissionSource& source, size_t face, std::span<const FaceTriangle> triangles)
{
    const formats::BspFace& of_map = source.bsp.faces[face];
    const BspTexinfo& texinfo = source.bsp.texinfos[of_map.texinfo];
    const FaceTexture& texture = source.textures[of_map.texinfo];
    const bool is_sky = classify(texinfo) == Emission::sky;
    const bool glows = is_glowing(texinfo, texture);
    const float glow = glow_factor(texture, source.scales);
    const glm::vec3 radiance = is_sky ? average_radiance(texinfo, texture, source.scales)
        : glows                       ? glow * texture.average
                                      : face_radiance(source, of_map.texinfo);
    if (!(max_component(radiance) > 0) && !is_sky)
        return {};
    const float scale = glows ? glow : scale_of_parts(triangles, texture.parts, radiance);
    const bool glows_in_parts = glows && !texture.parts.empty();
    std::vector<shared::Emitter> emitters;
    for (const FaceTriangle& triangle : triangles) {
        if (triangle.part == FacePiece::dark || (glows_in_parts && triangle.part == FaceTriangle::whole))
            continue;
        shared::Emitter emitter {};
        emitter.p0 = triangle.corners[0];
        emitter.p1 = triangle.corners[1];
        emitter.p2 = triangle.corners[2];
        emitter.type = emitter_type(texinfo);
        emitter.area = area_of(triangle);
        emitter.lightstyle = is_sky ? 0 : face_lightstyle(of_map, texture);
        emitter.radiance
            = triangle.part == FaceTriangle::whole ? radiance : scale * texture.parts[size_t(triangle.part)].average;
        emitters.push_back(emitter);
    }
    return emitters;
}

StaticEmitters extract_emitters(const EmissionSource& source, FaceTriangles& faces)
{
    const Bsp& bsp = source.bsp;
    StaticEmitters result;
    result.first_of_face.assign(bsp.faces.size(), -1);
    result.count_of_face.assign(bsp.faces.size(), 0);
    for (size_t i = 0; i < bsp.texinfos.size(); i++)
        result.face_emission.push_back(emission_factor(bsp.texinfos[i], source.textures[i], source.scales));

    std::vector<Piece> pieces;
    const std::vector<shared::Emitter> lights = extract_point_lights(bsp, source.scales, result.messages);
    if (!bsp.models.empty())
        pieces = collect_faces(source, faces, lights);
    for (const shared::Emitter& light : lights)
        pieces.push_back({ bsp.find_leaf(light.p0, find_world_root(bsp)), -1, { light } });
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.leaf < b.leaf; });

    for (const Piece& piece : pieces) {
        if (piece.face >= 0) {
            const size_t face = size_t(piece.face);
            result.first_of_face[face] = int32_t(result.emitters.size());
            result.count_of_face[face] = uint32_t(piece.emitters.size());
            number_emitters(faces.of(face), result.first_of_face[face]);
        }
        result.emitters.insert(result.emitters.end(), piece.emitters.begin(), piece.emitters.end());
    }
    report_unused(source, result.messages);
    return result;
}

shared::Emitter make_dynamic_light(glm::vec3 origin, glm::vec3 colour, float intensity, float radius)
{
    // At d = intensity / 2 the engine adds 255 * colour * (intensity - d) / 255 lightmap units, and the fade of
    // shaders/lib/emitters.glsl, (1 - (d / reach)^4)^2, has the value below.
    constexpr float fade_at_half = 0.9375f * 0.9375f;
    constexpr float pi = std::numbers::pi_v<float>;
    const float half = 0.5f * intensity;
    const float radiant_intensity = pi * half * half * half / (128 * fade_at_half);
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = origin;
    emitter.p1 = glm::vec3(radius, 0, 0);
    emitter.area = 4 * pi * radius * radius;
    emitter.radiance = glm::max(colour, glm::vec3(0)) * (radiant_intensity / (pi * radius * radius));
    emitter.reach = intensity;
    return emitter;
}

} // namespace vkpt
