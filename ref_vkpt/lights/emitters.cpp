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
#include <numeric>

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

// The classic compilers scale the picture's average colour so that its greatest component is 1.
glm::vec3 normalise_colour(glm::vec3 colour)
{
    const float greatest = max_component(colour);
    return greatest > 0 ? colour / greatest : glm::vec3(0);
}

glm::vec3 average_radiance(const BspTexinfo& texinfo, const PictureColour& picture, const EmissionScales& scales)
{
    const glm::vec3 average = glm::max(picture.average, glm::vec3(0));
    if ((texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0)
        return scales.face * float(texinfo.value) * picture.strength * normalise_colour(average);
    return scales.sky * average;
}

// What the picture is multiplied by, so that the average over the picture is average_radiance.
glm::vec3 emission_factor(const BspTexinfo& texinfo, const AverageColour& colour, const EmissionScales& scales)
{
    const PictureColour picture = colour(texinfo.texture);
    if (is_glowing(texinfo, picture))
        return glm::vec3(scales.glow);
    if (classify(texinfo) != Emission::face)
        return glm::vec3(0);
    const float greatest = max_component(picture.average);
    return greatest > 0 ? glm::vec3(scales.face * float(texinfo.value) * picture.strength / greatest) : glm::vec3(0);
}

// Where in the tree a face's front lies: leaves are numbered in tree order, so near numbers are near places.
size_t find_leaf_before(const Bsp& bsp, size_t face)
{
    const std::vector<glm::vec3> outline = face_outline(bsp, face);
    const glm::vec3 sum = std::accumulate(outline.begin(), outline.end(), glm::vec3(0));
    return bsp.find_leaf(sum / std::max(1.0f, float(outline.size())) + bsp.face_normal(face), find_world_root(bsp));
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

std::vector<Piece> collect_faces(const Bsp& bsp, const AverageColour& colour, const EmissionScales& scales,
    const std::vector<shared::Emitter>& lights)
{
    constexpr uint64_t comparisons_per_step = 64;
    std::vector<Piece> pieces;
    WorkLimit work = limit_of_pieces(bsp);
    const formats::BspModel& world = bsp.models[0];
    for (int32_t i = 0; i < world.face_count; i++) {
        const size_t face = size_t(world.first_face + i);
        std::vector<shared::Emitter> emitters = emitters_of_face(bsp, face, colour, scales, work);
        if (const BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
            !emitters.empty() && is_glowing(texinfo, colour(texinfo.texture))) {
            work.spend(emitters.size() * lights.size() / comparisons_per_step, "face", face);
            if (has_light_before(emitters, lights))
                continue;
        }
        if (!emitters.empty())
            pieces.push_back({ find_leaf_before(bsp, face), int64_t(face), std::move(emitters) });
    }
    return pieces;
}

// Names the textures that were meant to emit and do not.
void report_unused(const Bsp& bsp, const AverageColour& colour, std::vector<std::string>& messages)
{
    std::map<std::string, size_t> black, undrawn;
    for (const formats::BspFace& face : bsp.faces) {
        const BspTexinfo& texinfo = bsp.texinfos[face.texinfo];
        const bool meant = (texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0;
        if (meant && classify(texinfo) == Emission::none)
            undrawn[texinfo.texture]++;
        else if (meant && !(max_component(colour(texinfo.texture).average) > 0))
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

bool is_glowing(const BspTexinfo& texinfo, const PictureColour& picture)
{
    return picture.glows && !picture.parts.empty() && texinfo.next < 0 && classify(texinfo) == Emission::none
        && !(texinfo.flags & (formats::SURF_NODRAW | formats::SURF_WARP));
}

std::vector<FaceTriangle> triangles_of_face(const Bsp& bsp, size_t face, const PictureColour& picture, WorkLimit& work)
{
    const glm::vec3 normal = bsp.face_normal(face);
    std::vector<FaceTriangle> triangles;
    const auto append = [&](const std::vector<glm::vec3>& outline, int part) {
        for (const auto& [a, b, c] : triangulate(outline, normal))
            triangles.push_back({ { outline[a], outline[b], outline[c] }, part });
    };
    const BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
    const bool shines = classify(texinfo) == Emission::face || is_glowing(texinfo, picture);
    if (shines && texinfo.next < 0) // an animation's pictures shine in different places
        for (const FacePiece& piece : cut_face(bsp, face, picture.parts, picture.size, work))
            append(piece.outline, piece.part);
    if (triangles.empty())
        append(face_outline(bsp, face), FaceTriangle::whole);
    return triangles;
}

namespace {

float area_of(const FaceTriangle& t) { return triangle_area(t.corners[0], t.corners[1], t.corners[2]); }

// What the parts' colours are multiplied by, so that together they send what the whole face would if it had its average
// radiance.
float scale_of_parts(
    const std::vector<FaceTriangle>& triangles, const std::vector<BrightPart>& parts, glm::vec3 average_radiance)
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

uint32_t face_lightstyle(const formats::BspFace& face)
{
    constexpr uint8_t steady = 0, no_lightmap = 255;
    for (const uint8_t style : face.styles)
        if (style != steady && style != no_lightmap)
            return style;
    return steady;
}

glm::vec3 frame_radiance(const Bsp& bsp, uint32_t texinfo, const AverageColour& colour, const EmissionScales& scales)
{
    const BspTexinfo& frame = bsp.texinfos[texinfo];
    return classify(frame) == Emission::face ? average_radiance(frame, colour(frame.texture), scales) : glm::vec3(0);
}

glm::vec3 face_radiance(const Bsp& bsp, uint32_t texinfo, const AverageColour& colour, const EmissionScales& scales)
{
    glm::vec3 brightest(0);
    for_each_frame(bsp, texinfo, [&](uint32_t frame) {
        const glm::vec3 radiance = frame_radiance(bsp, frame, colour, scales);
        if (luminance(radiance) > luminance(brightest))
            brightest = radiance;
    });
    return brightest;
}

std::vector<shared::Emitter> emitters_of_face(
    const Bsp& bsp, size_t face, const AverageColour& colour, const EmissionScales& scales, WorkLimit& work)
{
    const BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
    const bool is_sky = classify(texinfo) == Emission::sky;
    const PictureColour picture = colour(texinfo.texture);
    const glm::vec3 radiance = is_sky ? average_radiance(texinfo, picture, scales)
                                      : face_radiance(bsp, bsp.faces[face].texinfo, colour, scales);
    const bool glows = is_glowing(texinfo, picture);
    if (!(max_component(radiance) > 0) && !is_sky && !glows)
        return {};
    const std::vector<FaceTriangle> triangles = triangles_of_face(bsp, face, picture, work);
    const float scale = glows ? scales.glow : scale_of_parts(triangles, picture.parts, radiance);
    std::vector<shared::Emitter> emitters;
    for (const FaceTriangle& triangle : triangles) {
        if (triangle.part == FacePiece::dark || (glows && triangle.part == FaceTriangle::whole))
            continue;
        shared::Emitter emitter {};
        emitter.p0 = triangle.corners[0];
        emitter.p1 = triangle.corners[1];
        emitter.p2 = triangle.corners[2];
        emitter.type = emitter_type(texinfo);
        emitter.area = area_of(triangle);
        emitter.lightstyle = is_sky ? 0 : face_lightstyle(bsp.faces[face]);
        emitter.radiance
            = triangle.part == FaceTriangle::whole ? radiance : scale * picture.parts[size_t(triangle.part)].average;
        emitters.push_back(emitter);
    }
    return emitters;
}

StaticEmitters extract_emitters(const Bsp& bsp, const AverageColour& colour, const EmissionScales& scales)
{
    StaticEmitters result;
    result.first_of_face.assign(bsp.faces.size(), -1);
    result.count_of_face.assign(bsp.faces.size(), 0);
    for (const BspTexinfo& texinfo : bsp.texinfos)
        result.face_emission.push_back(emission_factor(texinfo, colour, scales));

    std::vector<Piece> pieces;
    const std::vector<shared::Emitter> lights = extract_point_lights(bsp, scales, result.messages);
    if (!bsp.models.empty())
        pieces = collect_faces(bsp, colour, scales, lights);
    for (const shared::Emitter& light : lights)
        pieces.push_back({ bsp.find_leaf(light.p0, find_world_root(bsp)), -1, { light } });
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.leaf < b.leaf; });

    for (const Piece& piece : pieces) {
        if (piece.face >= 0) {
            result.first_of_face[size_t(piece.face)] = int32_t(result.emitters.size());
            result.count_of_face[size_t(piece.face)] = uint32_t(piece.emitters.size());
        }
        result.emitters.insert(result.emitters.end(), piece.emitters.begin(), piece.emitters.end());
    }
    report_unused(bsp, colour, result.messages);
    return result;
}

std::vector<shared::Emitter> emitters_of_brush_model(
    const Bsp& bsp, size_t model, const AverageColour& colour, const EmissionScales& scales)
{
    std::vector<shared::Emitter> emitters;
    WorkLimit work = limit_of_pieces(bsp);
    const formats::BspModel& source = bsp.models[model];
    for (int32_t i = 0; i < source.face_count; i++) {
        const std::vector<shared::Emitter> of_face
            = emitters_of_face(bsp, size_t(source.first_face + i), colour, scales, work);
        emitters.insert(emitters.end(), of_face.begin(), of_face.end());
    }
    return emitters;
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
