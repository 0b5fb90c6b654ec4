// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/brush_mesh.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <numeric>

namespace vkpt {

namespace {

std::vector<uint32_t> ascending(size_t count)
{
    std::vector<uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

std::vector<uint32_t> find_texinfos(std::span<const shared::Triangle> triangles)
{
    std::vector<uint32_t> texinfos;
    for (const shared::Triangle& triangle : triangles)
        texinfos.push_back(triangle.material);
    std::ranges::sort(texinfos);
    texinfos.erase(std::unique(texinfos.begin(), texinfos.end()), texinfos.end());
    return texinfos;
}

} // namespace

BrushMesh make_brush_mesh(std::span<const shared::Triangle> triangles, std::span<const uint32_t> masks)
{
    BrushMesh mesh;
    mesh.usable = !triangles.empty();
    std::vector<Box> boxes(triangles.size());
    for (size_t i = 0; i < triangles.size(); i++)
        for (const glm::vec3 p : triangles[i].positions) {
            boxes[i].add(p);
            mesh.box.add(p);
            mesh.usable &= is_sane(p);
        }
    if (!mesh.usable)
        return mesh;
    if (boxes.size() <= max_mesh_triangles)
        mesh.tree = build_mesh_tree(boxes);
    else
        mesh.tree.order = ascending(boxes.size());
    mesh.corners = ascending(triangles.size() * 3);
    mesh.texinfos = find_texinfos(triangles);
    for (const uint32_t from : mesh.tree.order) {
        shared::Triangle& triangle = mesh.triangles.emplace_back(triangles[from]);
        mesh.masks.push_back(masks[from]);
        triangle.material
            = uint32_t(std::ranges::lower_bound(mesh.texinfos, triangle.material) - mesh.texinfos.begin());
        for (const glm::vec3 p : triangle.positions)
            mesh.points.push_back(to_float4(p));
    }
    return mesh;
}

Box bounds_of(const BrushMesh& mesh, const Transform& transform)
{
    const glm::vec3 half = (mesh.box.high - mesh.box.low) * 0.5f, centre = transform.point(mesh.box.centre());
    glm::vec3 reach(0);
    for (int column = 0; column < 3; column++)
        reach += glm::abs(transform.rotation[column]) * half[column];
    reach += 1e-6f * (glm::abs(centre) + reach); // for the rounding here and in pose_points()
    return { centre - reach, centre + reach };
}

void pose_points(const BrushMesh& mesh, const Transform& transform, std::vector<Float4>& points)
{
    const Float4 x = to_float4(transform.rotation[0]), y = to_float4(transform.rotation[1]),
                 z = to_float4(transform.rotation[2]), origin = to_float4(transform.origin);
    points.resize(std::max(points.size(), mesh.points.size()));
    for (size_t i = 0; i < mesh.points.size(); i++) {
        const Float4 p = mesh.points[i];
        points[i] = origin + (x * p[0] + y * p[1] + z * p[2]);
    }
}

} // namespace vkpt
