// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_cache.hpp"

#include "ref_vkpt/lights/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

namespace vkpt {

namespace {

using shared::CACHE_LAYERS;
using Styles = std::set<uint32_t>;

constexpr float min_face_area = 0.1f; // of a face with cells
constexpr float coarsest_cell = 1 << 17; // larger than any map
constexpr uint32_t max_cells_across = (1u << shared::CACHE_SIZE_BITS) - 1;

// A face in its own plane: the first corner of its bounds, two axes along them, and the outline in units from there.
struct FlatFace {
    glm::vec3 origin, across, down;
    glm::vec2 size { 0 }; // 0: no cells
    std::vector<glm::vec2> outline;
};

// Axes along the longest edge: cells then fit rectangles.
FlatFace flatten_face(const std::vector<glm::vec3>& outline, glm::vec3 normal)
{
    FlatFace flat {};
    glm::vec3 longest(0);
    for (size_t i = 0; i < outline.size(); i++) {
        const glm::vec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        if (glm::dot(edge, edge) > glm::dot(longest, longest))
            longest = edge;
    }
    flat.across = longest - normal * glm::dot(longest, normal);
    const float length = glm::length(flat.across);
    if (!(length > 0) || !std::isfinite(length))
        return flat;
    flat.across /= length;
    flat.down = glm::cross(normal, flat.across);
    glm::vec2 mins(INFINITY), maxs(-INFINITY);
    for (const glm::vec3& corner : outline) {
        flat.outline.emplace_back(glm::dot(corner - outline[0], flat.across), glm::dot(corner - outline[0], flat.down));
        mins = glm::min(mins, flat.outline.back());
        maxs = glm::max(maxs, flat.outline.back());
    }
    for (glm::vec2& corner : flat.outline)
        corner -= mins;
    flat.origin = outline[0] + flat.across * mins.x + flat.down * mins.y;
    // Also false where a number is none.
    if (measure_area(outline) >= min_face_area)
        flat.size = maxs - mins;
    return flat;
}

glm::uvec2 count_cells(const FlatFace& face, float cell_size)
{
    return glm::max(glm::uvec2(glm::ceil(face.size / cell_size - 1e-3f)), glm::uvec2(1));
}

// Cells of all faces, or something greater than `max_cache_cells`.
size_t count_all_cells(std::span<const FlatFace> faces, float cell_size)
{
    size_t count = 0;
    for (const FlatFace& face : faces) {
        if (face.size == glm::vec2(0))
            continue;
        if (std::max(face.size.x, face.size.y) > cell_size * float(max_cells_across))
            return max_cache_cells + 1;
        const glm::uvec2 cells = count_cells(face, cell_size);
        count += size_t(cells.x) * cells.y;
        if (count > max_cache_cells)
            break;
    }
    return count;
}

bool has_cells(const formats::BspTexinfo& texinfo)
{
    using namespace formats;
    return (texinfo.flags & (SURF_NODRAW | SURF_SKIP | SURF_HINT | SURF_SKY | SURF_TRANS33 | SURF_TRANS66)) == 0;
}

std::vector<FlatFace> flatten_faces(const formats::Bsp& bsp)
{
    std::vector<FlatFace> faces(bsp.faces.size());
    const formats::BspModel& model = bsp.models[0];
    for (size_t i = size_t(model.first_face); i < size_t(model.first_face + model.face_count); i++)
        if (has_cells(bsp.texinfos[bsp.faces[i].texinfo]))
            faces[i] = flatten_face(bsp.face_polygon(i), bsp.face_normal(i));
    return faces;
}

// The lightstyles of each face's lights, and the cluster that it lies in, if it is one alone.
struct FaceLights {
    Styles styles;
    int cluster = -1;
    bool several = false;
    bool known = false; // some leaf names the face
};

std::vector<FaceLights> find_face_lights(
    const formats::Bsp& bsp, const LightLists& lists, std::span<const shared::Emitter> emitters)
{
    std::vector<Styles> of_list(lists.lists().size());
    for (size_t i = 0; i < of_list.size(); i++) {
        const shared::LightList& list = lists.lists()[i];
        for (uint32_t k = 0; k < list.static_count; k++)
            of_list[i].insert(emitters[lists.static_indices()[list.first_static + k]].lightstyle);
    }
    std::vector<FaceLights> faces(bsp.faces.size());
    for (const formats::BspLeaf& leaf : bsp.leaves)
        for (size_t i = 0; i < leaf.leaf_face_count; i++) {
            FaceLights& face = faces[bsp.leaf_faces[leaf.first_leaf_face + i]];
            const size_t list
                = leaf.cluster < 0 ? of_list.size() - 1 : std::min(size_t(leaf.cluster), of_list.size() - 1);
            face.several |= face.cluster >= 0 && face.cluster != leaf.cluster;
            face.cluster = leaf.cluster;
            face.known = true;
            if (face.styles.size() <= CACHE_LAYERS)
                face.styles.insert(of_list[list].begin(), of_list[list].end());
        }
    return faces;
}

float cross2(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

// What of a convex outline lies on the left of the line through `point` along `way`.
std::vector<glm::vec2> cut_outline(const std::vector<glm::vec2>& outline, glm::vec2 point, glm::vec2 way)
{
    std::vector<glm::vec2> kept;
    for (size_t i = 0; i < outline.size(); i++) {
        const glm::vec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        const float height_a = cross2(way, a - point), height_b = cross2(way, b - point);
        if (height_a >= 0)
            kept.push_back(a);
        if ((height_a < 0) != (height_b < 0))
            kept.push_back(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return kept;
}

// The middle of what of the outline lies in a cell, from the cell's corner; negative where that is nothing.
glm::vec2 middle_in_cell(const std::vector<glm::vec2>& outline, glm::vec2 cell)
{
    std::vector<glm::vec2> part = cut_outline(outline, cell, { 1, 0 });
    part = cut_outline(part, cell + glm::vec2(1, 0), { 0, 1 });
    part = cut_outline(part, cell + glm::vec2(1, 1), { -1, 0 });
    part = cut_outline(part, cell + glm::vec2(0, 1), { 0, -1 });
    glm::vec2 sum(0);
    for (const glm::vec2& corner : part)
        sum += corner;
    return part.empty() ? glm::vec2(-1) : sum / float(part.size()) - cell;
}

uint32_t pack_place(glm::vec2 place)
{
    const glm::uvec2 bits(glm::clamp(place, 0.0f, 1.0f) * 65535.0f + 0.5f);
    return bits.x | bits.y << 16;
}

class Layout {
public:
    explicit Layout(float cell_size) { result_.cell_size = cell_size; }

    void add(const FlatFace& face, const FaceLights& lights, glm::vec3 normal)
    {
        shared::CacheFace out {};
        shared::CacheFacePlane plane {};
        if (face.size != glm::vec2(0) && lights.known && lights.styles.size() <= CACHE_LAYERS) {
            out = make_face(face, lights.styles);
            plane = make_plane(face, lights, normal);
            add_cells(out, plane);
        }
        result_.faces.push_back(out);
        result_.planes.push_back(plane);
    }
    LightCacheLayout take() { return std::move(result_); }

private:
    shared::CacheFace make_face(const FlatFace& face, const Styles& styles) const
    {
        const float size = result_.cell_size;
        const glm::uvec2 cells = count_cells(face, size);
        const uint32_t layers = std::max<uint32_t>(uint32_t(styles.size()), 1);
        shared::CacheFace out {};
        out.across = glm::vec4(face.across, -glm::dot(face.origin, face.across)) / size;
        out.down = glm::vec4(face.down, -glm::dot(face.origin, face.down)) / size;
        out.first_value = result_.value_count;
        out.size = cells.x | cells.y << shared::CACHE_SIZE_BITS | layers << (2 * shared::CACHE_SIZE_BITS);
        uint32_t packed[CACHE_LAYERS];
        std::fill(std::begin(packed), std::end(packed), shared::CACHE_NO_STYLE);
        std::ranges::copy(styles, packed);
        if (styles.empty())
            packed[0] = 0;
        out.styles[0] = packed[0] | packed[1] << 16;
        out.styles[1] = packed[2] | packed[3] << 16;
        return out;
    }

    shared::CacheFacePlane make_plane(const FlatFace& face, const FaceLights& lights, glm::vec3 normal)
    {
        const float size = result_.cell_size;
        const uint32_t first = uint32_t(result_.corners.size());
        for (const glm::vec2& corner : face.outline)
            result_.corners.push_back(corner / size);
        return { face.origin, first, face.across * size, uint32_t(face.outline.size()), face.down * size,
            lights.several ? -1 : lights.cluster, normal, 0 };
    }

    void add_cells(const shared::CacheFace& face, const shared::CacheFacePlane& plane)
    {
        const auto first = result_.corners.begin() + plane.first_corner;
        const std::vector<glm::vec2> outline(first, first + plane.corner_count);
        const uint32_t across = face.size & max_cells_across,
                       down = face.size >> shared::CACHE_SIZE_BITS & max_cells_across,
                       layers = face.size >> (2 * shared::CACHE_SIZE_BITS);
        const uint32_t number = uint32_t(result_.faces.size());
        for (uint32_t y = 0; y < down; y++)
            for (uint32_t x = 0; x < across; x++) {
                const glm::vec2 middle = middle_in_cell(outline, glm::vec2(x, y));
                // Cells that the face leaves empty are never read, and not updated.
                if (middle.x >= 0)
                    result_.cells.push_back({ number, result_.value_count, pack_place(middle), 0 });
                result_.value_count += layers;
            }
    }

    LightCacheLayout result_;
};

} // namespace

LightCacheLayout lay_out_light_cache(
    const formats::Bsp& bsp, const LightLists& lists, std::span<const shared::Emitter> emitters)
{
    std::vector<FlatFace> faces = flatten_faces(bsp);
    float cell_size = finest_cache_cell;
    while (count_all_cells(faces, cell_size) > max_cache_cells && cell_size < coarsest_cell)
        cell_size *= 2;
    if (count_all_cells(faces, cell_size) > max_cache_cells)
        faces.assign(faces.size(), {}); // not even with one cell each
    const std::vector<FaceLights> lights = find_face_lights(bsp, lists, emitters);
    Layout layout(cell_size);
    for (size_t i = 0; i < faces.size(); i++)
        layout.add(faces[i], lights[i], bsp.face_normal(i));
    return layout.take();
}

} // namespace vkpt
