// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_multisets.hpp"

#include "ref_vkpt/lights/light_source.hpp"
#include "ref_vkpt/lights/sampler_tables.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <random>
#include <utility>

namespace vkpt {

namespace {

using shared::Emitter;

// Per cluster. Fewer in maps whose lists are long, so that there are about so many predictions (a quarter of a second).
constexpr size_t max_points = 48, min_points = 6, max_predictions = 16'000'000;
constexpr size_t points_per_point_in_air = 6;
// Of what arrives: large lights reach above the horizon though their centre does not.
constexpr float min_cosine = 0.02f;
constexpr float cosine_in_air = 0.5f; // things there look anywhere
constexpr float nearest_share = 0.02f; // of the square of what a light may have at its nearest place
constexpr size_t copies_per_light = 2; // beyond one each, on average over a list
constexpr size_t max_copies = 1024; // in one multiset beyond one each: longer ones leave the caches
constexpr int max_exponent = 10;

struct Receiver {
    glm::vec3 position, normal; // normal 0: in the air
};

// About the irradiance: a disc's, never closer than it is large.
float predict_irradiance(const LightSource& source, const Receiver& receiver)
{
    const glm::vec3 to_receiver = receiver.position - source.centre;
    const float distance2 = std::max(glm::dot(to_receiver, to_receiver), 1e-6f), inverse = 1 / std::sqrt(distance2);
    const float sent
        = source.normal == glm::vec3(0) ? 1 : std::max(glm::dot(to_receiver, source.normal) * inverse, 0.0f);
    const float arriving = receiver.normal == glm::vec3(0)
        ? cosine_in_air
        : std::max(-glm::dot(to_receiver, receiver.normal) * inverse, min_cosine);
    return source.power * sent * arriving / std::max(distance2, source.area);
}

float predict_max_irradiance(const LightSource& source, const Bounds& bounds)
{
    const glm::vec3 to_receiver = glm::clamp(source.centre, bounds.mins, bounds.maxs) - source.centre;
    return source.power / std::max(glm::dot(to_receiver, to_receiver), 2 * source.area);
}

bool holds(const Bounds& bounds, glm::vec3 p)
{
    return !glm::any(glm::lessThan(p, bounds.mins)) && !glm::any(glm::greaterThan(p, bounds.maxs));
}

// The lit faces of a cluster as triangles to draw points from.
class ClusterFaces {
public:
    void add(const formats::Bsp& bsp, size_t face, std::span<const FaceTriangle> triangles)
    {
        if (bsp.texinfos[bsp.faces[face].texinfo].flags & (formats::SURF_SKY | formats::SURF_NODRAW))
            return;
        for (const FaceTriangle& triangle : triangles) {
            const auto& [a, b, c] = triangle.corners;
            triangles_.push_back({ a, b, c, bsp.face_normal(face) });
            areas_.push_back((areas_.empty() ? 0 : areas_.back()) + triangle_area(a, b, c));
        }
    }

    // Faces reach into other clusters: only what is in the bounds counts.
    std::vector<Receiver> draw(const Bounds& bounds, size_t count, std::mt19937& rng) const
    {
        const size_t points_in_air = count / points_per_point_in_air, points_on_faces = count - points_in_air;
        const size_t tries = 8 * points_on_faces;
        std::uniform_real_distribution<float> unit(0, 1);
        std::vector<Receiver> receivers;
        for (size_t i = 0; i < tries && receivers.size() < points_on_faces && !areas_.empty(); i++) {
            const auto at = std::ranges::upper_bound(areas_, unit(rng) * areas_.back());
            const Triangle& t = triangles_[std::min(size_t(at - areas_.begin()), areas_.size() - 1)];
            const float root = std::sqrt(unit(rng)), v = unit(rng);
            const glm::vec3 p = t.a * (1 - root) + t.b * (root * (1 - v)) + t.c * (root * v) + t.normal;
            if (holds(bounds, p))
                receivers.push_back({ p, t.normal });
        }
        for (size_t i = 0; i < points_in_air; i++) {
            const glm::vec3 place(unit(rng), unit(rng), unit(rng));
            receivers.push_back({ glm::mix(bounds.mins, bounds.maxs, place), glm::vec3(0) });
        }
        return receivers;
    }

private:
    struct Triangle {
        glm::vec3 a, b, c, normal;
    };
    std::vector<Triangle> triangles_;
    std::vector<float> areas_; // running sums
};

// The leaves of each cluster, in their order.
std::vector<std::vector<uint32_t>> collect_leaves(const formats::Bsp& bsp, size_t cluster_count)
{
    std::vector<std::vector<uint32_t>> clusters(cluster_count);
    for (uint32_t i = 0; i < bsp.leaves.size(); i++)
        if (const int cluster = bsp.leaves[i].cluster; cluster >= 0 && size_t(cluster) < cluster_count)
            clusters[size_t(cluster)].push_back(i);
    return clusters;
}

ClusterFaces collect_faces(const formats::Bsp& bsp, const FaceTriangles& all, const std::vector<uint32_t>& leaves)
{
    ClusterFaces faces;
    for (const uint32_t index : leaves) {
        const formats::BspLeaf& leaf = bsp.leaves[index];
        for (size_t i = 0; i < leaf.leaf_face_count; i++) {
            const size_t face = bsp.leaf_faces[leaf.first_leaf_face + i];
            faces.add(bsp, face, all.of(face));
        }
    }
    return faces;
}

// Per light, in proportion to which they are to be drawn.
std::vector<float> measure_sizes(
    const std::vector<LightSource>& sources, const std::vector<Receiver>& receivers, const Bounds& bounds)
{
    std::vector<float> squares(sources.size(), 0), light(sources.size());
    float mean_sum = 0;
    for (const Receiver& receiver : receivers) {
        float sum = 0;
        for (size_t i = 0; i < sources.size(); i++)
            sum += light[i] = predict_irradiance(sources[i], receiver);
        mean_sum += sum / float(receivers.size());
        if (!(sum > 0))
            continue;
        for (size_t i = 0; i < sources.size(); i++)
            squares[i] += light[i] / sum * (light[i] / sum) / float(receivers.size());
    }
    for (size_t i = 0; i < sources.size(); i++) {
        const float most = predict_max_irradiance(sources[i], bounds);
        const float share = most > 0 ? most / (most + mean_sum) : 0;
        squares[i] = std::sqrt(squares[i] + nearest_share * share * share);
    }
    return squares;
}

// The power of two next to `copies`, at least 1.
uint32_t round_to_exponent(float copies)
{
    return copies > 1 ? uint32_t(std::clamp(int(std::lround(std::log2(copies))), 0, max_exponent)) : 0;
}

} // namespace

LightMultisets make_light_multisets(const formats::Bsp& bsp, const FaceTriangles& faces, const LightLists& lists,
    std::span<const Emitter> static_emitters)
{
    LightMultisets result;
    result.entries = lists.static_indices();
    for (const shared::LightList& list : lists.lists()) // for outside every cluster, that is all
        result.ranges.push_back({ list.first_static, list.static_count });
    std::vector<LightSource> sources;
    for (const Emitter& emitter : static_emitters)
        sources.push_back(make_light_source(emitter));
    const size_t cluster_count = lists.lists().size() - 1;
    const std::vector<std::vector<uint32_t>> leaves = collect_leaves(bsp, cluster_count);
    const size_t points
        = std::clamp(max_predictions / std::max<size_t>(lists.static_indices().size(), 1), min_points, max_points);
    std::mt19937 rng;
    for (size_t cluster = 0; cluster < cluster_count; cluster++) {
        const shared::LightList& list = lists.lists()[cluster];
        if (list.static_count == 0)
            continue;
        const std::span indices = std::span(lists.static_indices()).subspan(list.first_static, list.static_count);
        std::vector<LightSource> listed;
        for (const uint32_t index : indices)
            listed.push_back(sources[index]);
        const Bounds bounds = lists.cluster_bounds(cluster);
        const ClusterFaces lit = collect_faces(bsp, faces, leaves[cluster]); // one cluster's at a time: they are large
        const std::vector<float> sizes = measure_sizes(listed, lit.draw(bounds, points, rng), bounds);
        float total = 0;
        for (const float size : sizes)
            total += size;
        const size_t first = result.entries.size();
        const float copies = float(std::min(copies_per_light * indices.size(), max_copies));
        for (size_t i = 0; i < indices.size(); i++) {
            const uint32_t exponent = total > 0 ? round_to_exponent(sizes[i] / total * copies) : 0;
            result.entries.insert(
                result.entries.end(), size_t(1) << exponent, indices[i] | exponent << shared::LIGHT_COPIES_SHIFT);
        }
        result.ranges[cluster] = { uint32_t(first), uint32_t(result.entries.size() - first) };
    }
    return result;
}

void add_light_multisets(const SamplerTableSource& source, SamplerTables& tables)
{
    if (!source.bsp)
        return;
    LightMultisets multisets = make_light_multisets(*source.bsp, *source.faces, *source.light_lists, source.emitters);
    tables.multisets = std::move(multisets.ranges);
    tables.indices = std::move(multisets.entries);
}

} // namespace vkpt
