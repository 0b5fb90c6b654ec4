// SPDX-License-Identifier: GPL-2.0-or-later
// What users ask of a map once it is read.
#include "formats/bsp.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace formats {

namespace {

constexpr double luxel_size = 16; // texels
constexpr double max_luxels = 4096; // per axis; compilers stay below 18, so more means senseless axes

// Byte offset of the cluster's compressed row; the reader has checked it, hand-made maps may lack it.
size_t visibility_row(const Bsp& bsp, int cluster)
{
    const size_t at = sizeof(int32_t) * (1 + 2 * size_t(cluster));
    if (at + sizeof(int32_t) > bsp.visibility.size())
        return bsp.visibility.size();
    uint32_t offset;
    std::memcpy(&offset, bsp.visibility.data() + at, sizeof(offset));
    return std::min<size_t>(offset, bsp.visibility.size());
}

} // namespace

std::vector<glm::vec3> Bsp::face_polygon(size_t face) const
{
    const BspFace& f = faces[face];
    std::vector<glm::vec3> polygon(f.edge_count);
    for (size_t i = 0; i < polygon.size(); i++) {
        const int32_t edge = surface_edges[size_t(f.first_edge) + i];
        const uint32_t vertex = edge >= 0 ? edges[size_t(edge)].vertices[0] : edges[size_t(-edge)].vertices[1];
        polygon[polygon.size() - 1 - i] = vertices[vertex]; // on disk clockwise
    }
    return polygon;
}

glm::vec3 Bsp::face_normal(size_t face) const
{
    const glm::vec3 normal = planes[faces[face].plane].normal;
    return faces[face].side ? -normal : normal;
}

glm::vec2 Bsp::texture_coordinates(const BspTexinfo& texinfo, glm::vec3 p) const
{
    return { glm::dot(p, texinfo.s_axis) + texinfo.s_offset, glm::dot(p, texinfo.t_axis) + texinfo.t_offset };
}

Bsp::LightmapExtent Bsp::lightmap_extent(size_t face) const
{
    const BspTexinfo& texinfo = texinfos[faces[face].texinfo];
    if (texinfo.flags & (SURF_SKY | SURF_WARP))
        return {};
    const std::vector<glm::vec3> polygon = face_polygon(face);
    LightmapExtent extent;
    for (int axis = 0; axis < 2; axis++) {
        const glm::vec3 direction = axis == 0 ? texinfo.s_axis : texinfo.t_axis;
        const double offset = axis == 0 ? texinfo.s_offset : texinfo.t_offset;
        double lowest = INFINITY, highest = -INFINITY;
        for (const glm::vec3& p : polygon) {
            const double value
                = double(p.x) * direction.x + double(p.y) * direction.y + double(p.z) * direction.z + offset;
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
        }
        const double first = std::floor(lowest / luxel_size), last = std::ceil(highest / luxel_size);
        if (!(last - first < max_luxels))
            return {};
        extent.size[axis] = int(last - first) + 1;
        extent.min_st[axis] = float(first * luxel_size);
    }
    return extent;
}

size_t Bsp::find_leaf(glm::vec3 p, int head_node) const
{
    int at = nodes.empty() && head_node >= 0 ? -1 : head_node;
    while (at >= 0) {
        const BspNode& node = nodes[size_t(at)];
        const BspPlane& plane = planes[size_t(node.plane)];
        at = node.children[glm::dot(p, plane.normal) - plane.dist < 0 ? 1 : 0];
    }
    return size_t(-(int64_t(at) + 1));
}

int Bsp::find_cluster(glm::vec3 p) const
{
    return leaves[find_leaf(p, models.empty() ? 0 : models[0].head_node)].cluster;
}

ClusterSet Bsp::pvs(int cluster) const
{
    if (cluster_count <= 0) {
        int highest = -1;
        for (const BspLeaf& leaf : leaves)
            highest = std::max<int>(highest, leaf.cluster);
        ClusterSet everything(size_t(highest + 1));
        if (cluster >= 0)
            for (int other = 0; other <= highest; other++)
                everything.insert(other);
        return everything;
    }
    ClusterSet set { size_t(cluster_count) };
    if (cluster < 0 || cluster >= cluster_count)
        return set;

    // A byte other than 0 stands for itself; 0 is followed by how many zero bytes it stands for.
    std::vector<uint8_t>& row = set.bytes();
    size_t in = visibility_row(*this, cluster);
    for (size_t out = 0; out < row.size() && in < visibility.size(); in++) {
        if (visibility[in] != 0) {
            row[out++] = visibility[in];
            continue;
        }
        if (++in == visibility.size() || visibility[in] == 0)
            break;
        out += visibility[in];
    }
    if (cluster_count % 8 != 0)
        row.back() &= uint8_t((1 << (cluster_count % 8)) - 1);
    set.insert(cluster);
    return set;
}

} // namespace formats
