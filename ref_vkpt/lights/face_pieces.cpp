// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/face_pieces.hpp"

#include "ref_vkpt/lights/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

namespace vkpt {

namespace {

using Outline = std::vector<glm::vec3>;

constexpr int64_t max_tile_count = 64; // of a face; with more of them a lamp is a dot
// Per megabyte of the map: corners looked at, the time of which grows with the square of a face's pieces.
constexpr uint64_t max_cutting_steps = 200'000'000;
constexpr uint64_t steps_of_cut = 24; // what cutting takes for a corner, in such steps
constexpr float farthest_tile = 1 << 20; // from the origin; beyond, a float no longer tells where in a tile it is
constexpr float cut_tolerance = 0.02f; // texels: corners so near to a cut lie on it
constexpr float min_piece_area = 0.01f; // units^2; smaller pieces are none

// Where a texture coordinate (0: u, 1: v) has a value.
struct Cut {
    const formats::Bsp& bsp;
    const formats::BspTexinfo& texinfo;
    int axis;
    float at; // texels
    float distance(glm::vec3 point) const { return bsp.texture_coordinates(texinfo, point)[axis] - at; }
};

// Both sides of the cut, corners on it on both: first where the coordinate is less. One of them may be no polygon.
std::array<Outline, 2> split(const Outline& outline, const Cut& cut)
{
    std::array<Outline, 2> sides;
    for (size_t i = 0; i < outline.size(); i++) {
        const glm::vec3 from = outline[i], to = outline[(i + 1) % outline.size()];
        const float a = cut.distance(from), b = cut.distance(to);
        if (a <= cut_tolerance)
            sides[0].push_back(from);
        if (a >= -cut_tolerance)
            sides[1].push_back(from);
        if (std::min(a, b) < -cut_tolerance && std::max(a, b) > cut_tolerance) {
            const glm::vec3 crossing = glm::mix(from, to, a / (a - b));
            sides[0].push_back(crossing);
            sides[1].push_back(crossing);
        }
    }
    for (Outline& side : sides)
        if (side.size() < 3 || measure_area(side) < min_piece_area)
            side.clear();
    return sides;
}

// A rectangle in texels.
struct Box {
    glm::vec2 mins, maxs;
    int part;
};

// Moves what of `outline` lies in the box into a piece of its own, and the rest, convex again, to `rest`.
void cut_out(const formats::Bsp& bsp, const formats::BspTexinfo& texinfo, Outline outline, const Box& box,
    std::vector<Outline>& rest, std::vector<FacePiece>& pieces)
{
    for (int axis = 0; axis < 2; axis++)
        for (int side = 0; side < 2; side++) {
            const bool keeps_less = side == 1;
            auto [less, more] = split(outline, { bsp, texinfo, axis, keeps_less ? box.maxs[axis] : box.mins[axis] });
            Outline& outside = keeps_less ? more : less;
            if (!outside.empty())
                rest.push_back(std::move(outside));
            outline = std::move(keeps_less ? less : more);
            if (outline.empty())
                return;
        }
    pieces.push_back({ std::move(outline), box.part });
}

// Every box of the tiled texture that the outline may show; nothing: too many.
std::optional<std::vector<Box>> find_boxes(const formats::Bsp& bsp, const formats::BspTexinfo& texinfo,
    const Outline& outline, const std::vector<BrightPart>& parts, glm::vec2 size)
{
    glm::vec2 mins(std::numeric_limits<float>::max()), maxs(-mins);
    for (const glm::vec3& corner : outline) {
        const glm::vec2 at = bsp.texture_coordinates(texinfo, corner);
        mins = glm::min(mins, at);
        maxs = glm::max(maxs, at);
    }
    const glm::vec2 first = glm::floor((mins + 0.5f) / size), end = glm::ceil((maxs - 0.5f) / size);
    const auto is_countable = [](float tile) { return std::abs(tile) < farthest_tile; };
    if (!is_countable(first.x) || !is_countable(first.y) || !is_countable(end.x) || !is_countable(end.y))
        return std::nullopt;
    const int64_t first_x = int64_t(first.x), end_x = int64_t(end.x), first_y = int64_t(first.y),
                  end_y = int64_t(end.y);
    if (end_x <= first_x || end_y <= first_y)
        return std::vector<Box>();
    if ((end_x - first_x) * (end_y - first_y) > max_tile_count)
        return std::nullopt;
    std::vector<Box> boxes;
    for (int64_t y = first_y; y < end_y; y++)
        for (int64_t x = first_x; x < end_x; x++)
            for (size_t i = 0; i < parts.size(); i++) {
                const glm::vec2 tile(x, y);
                boxes.push_back({ (tile + parts[i].mins) * size, (tile + parts[i].maxs) * size, int(i) });
            }
    return boxes;
}

size_t count_corners(const std::vector<Outline>& outlines)
{
    size_t count = 0;
    for (const Outline& outline : outlines)
        count += outline.size();
    return count;
}

// Makes corners that are meant to be one the same, and gives each edge the corners that others have on it, so that rays
// find no crack between pieces.
void weld(std::vector<FacePiece>& pieces, const Outline& face)
{
    constexpr float near2 = 2e-3f * 2e-3f;
    const auto distance2 = [](glm::vec3 a, glm::vec3 b) { return glm::dot(a - b, a - b); };
    Outline corners = face;
    for (FacePiece& piece : pieces)
        for (glm::vec3& corner : piece.outline) {
            const auto same = std::ranges::find_if(corners, [&](glm::vec3 c) { return distance2(c, corner) < near2; });
            if (same != corners.end())
                corner = *same;
            else
                corners.push_back(corner);
        }
    for (FacePiece& piece : pieces) {
        Outline whole;
        for (size_t i = 0; i < piece.outline.size(); i++) {
            const glm::vec3 from = piece.outline[i], edge = piece.outline[(i + 1) % piece.outline.size()] - from;
            const float length2 = glm::dot(edge, edge);
            if (length2 == 0)
                continue; // welded to one corner
            std::vector<std::pair<float, glm::vec3>> on_edge { { 0, from } };
            for (const glm::vec3& corner : corners) {
                const float product = glm::dot(corner - from, edge);
                if (!(product > 0) || product > 2 * length2) // most of them: far from the edge, without a division
                    continue;
                const float along = product / length2;
                if (along > 0 && along < 1 && corner != from && corner != from + edge
                    && distance2(corner, from + edge * along) < near2 && distance2(corner, from) >= near2
                    && distance2(corner, from + edge) >= near2)
                    on_edge.emplace_back(along, corner);
            }
            std::ranges::sort(on_edge, {}, &std::pair<float, glm::vec3>::first);
            for (const auto& [along, corner] : on_edge)
                whole.push_back(corner);
        }
        piece.outline = std::move(whole);
    }
}

} // namespace

float measure_area(const std::vector<glm::vec3>& outline)
{
    glm::vec3 doubled(0);
    for (size_t i = 2; i < outline.size(); i++)
        doubled += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    return 0.5f * glm::length(doubled);
}

WorkLimit limit_of_pieces(const formats::Bsp& bsp)
{
    return { bsp, max_cutting_steps, "steps to cut the lamps out of its faces' textures" };
}

std::vector<FacePiece> cut_face(
    const formats::Bsp& bsp, size_t face, const std::vector<BrightPart>& parts, glm::ivec2 size, WorkLimit& work)
{
    const formats::BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
    // What moves over the face, or changes, shines as a whole.
    if (parts.empty() || (texinfo.flags & (formats::SURF_WARP | formats::SURF_FLOWING)) || texinfo.next >= 0)
        return {};
    const Outline outline = bsp.face_polygon(face);
    const auto boxes = find_boxes(bsp, texinfo, outline, parts, glm::vec2(size));
    if (!boxes)
        return {};
    std::vector<FacePiece> pieces;
    std::vector<Outline> dark { outline };
    for (const Box& box : *boxes) {
        std::vector<Outline> rest;
        work.spend(count_corners(dark) * steps_of_cut, "face", face);
        for (Outline& piece : dark)
            cut_out(bsp, texinfo, std::move(piece), box, rest, pieces);
        dark = std::move(rest);
    }
    if (pieces.empty())
        return {};
    for (Outline& piece : dark)
        pieces.push_back({ std::move(piece), FacePiece::dark });
    size_t corners = 0;
    for (const FacePiece& piece : pieces)
        corners += piece.outline.size();
    work.spend(corners * (corners + outline.size()), "face", face);
    weld(pieces, outline);
    return pieces;
}

} // namespace vkpt
