// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/light_scene.hpp"

#include <algorithm>

namespace vkpt::tools {

using namespace formats;

Occlusion::Occlusion(const Bsp& bsp)
{
    const auto child = [&](int index) {
        if (index >= 0)
            return index;
        return bsp.leaves[size_t(-(index + 1))].contents & CONTENTS_SOLID ? -1 : -2;
    };
    for (const BspNode& node : bsp.nodes) {
        const BspPlane& plane = bsp.planes[size_t(node.plane)];
        nodes_.push_back({ plane.normal, plane.dist, std::min(plane.type, 3),
            { child(node.children[0]), child(node.children[1]) } });
    }
    root_ = child(bsp.models[0].head_node);
}

bool Occlusion::is_blocked(const dvec3& from, const dvec3& to) const
{
    return is_blocked_below(root_, glm::vec3(from), glm::vec3(to));
}

bool Occlusion::is_blocked_below(int index, const glm::vec3& from, const glm::vec3& to) const
{
    constexpr float tolerance = 0.1f; // grazing a surface does not block
    while (index >= 0) {
        const FlatNode& node = nodes_[size_t(index)];
        const bool axial = node.axis < 3;
        const float a = (axial ? from[node.axis] : glm::dot(node.normal, from)) - node.dist;
        const float b = (axial ? to[node.axis] : glm::dot(node.normal, to)) - node.dist;
        if (a >= -tolerance && b >= -tolerance) {
            index = node.children[0];
        } else if (a < tolerance && b < tolerance) {
            index = node.children[1];
        } else {
            const glm::vec3 middle = from + (to - from) * (a / (a - b));
            const int near = a < 0;
            return is_blocked_below(node.children[near], from, middle)
                || is_blocked_below(node.children[near ^ 1], middle, to);
        }
    }
    return index == -1;
}

LightScene::LightScene(const Bsp& map, const SourceMap& source_world)
    : bsp(map)
    , world(source_world)
    , occlusion(map)
    , face_origin(map.faces.size(), dvec3(0))
{
    int cluster_count = 0;
    for (const BspLeaf& leaf : bsp.leaves)
        cluster_count = std::max(cluster_count, leaf.cluster + 1);
    for (int cluster = 0; cluster < cluster_count; cluster++)
        pvs.push_back(bsp.pvs(cluster));
    for (const BspModel& model : bsp.models)
        std::fill_n(face_origin.begin() + model.first_face, model.face_count, dvec3(model.origin));
}

} // namespace vkpt::tools
