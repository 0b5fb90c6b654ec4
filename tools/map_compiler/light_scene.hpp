// SPDX-License-Identifier: GPL-2.0-or-later
// What the light baker works on: rays through the compiled map, light sources, and patches that bounce.
//
// The formulas are those of the classic Quake II tool, for whose look the game's maps and light values were made. L is
// in lightmap units (0..255), d the distance, n and n' the unit normals of receiver and source, w the unit direction to
// the source:
//   point light    L = (light - d) (n.w)                        linear, with no reach beyond its value
//   spot light     the same inside the cone (cosine of "_cone", 10 degrees unless told), else nothing
//   surface light  L = 0.4 value C A (n.w) (-n'.w) / d^2        C: light colour (see textures.cpp), A: the patch's area
//   bounces        radiosity between patches of at most 64 units; a patch's transfers (n.w)(-n'.w) A / d^2 are scaled
//                  to add up to 1, and what leaves is what came in times the reflectivity
#pragma once

#include "tools/map_compiler/brushes.hpp"

#include <span>

namespace vkpt::tools {

inline constexpr double surface_light_scale = 0.4;
inline constexpr double patch_size = 64;
inline constexpr int bounce_count = 8;
inline constexpr double brightest_luxel = 196;
// Faces whose emission is below this are not worth a light source.
inline constexpr double min_emission = 3;

// Sight through the world's tree; brush models cast no shadow.
class Occlusion {
public:
    explicit Occlusion(const formats::Bsp& bsp);
    bool is_blocked(const dvec3& from, const dvec3& to) const;

private:
    struct FlatNode {
        glm::vec3 normal;
        float dist;
        int axis; // 0..2: the normal is that axis, 3: any
        int children[2]; // < 0: leaf; -1 solid, -2 open
    };
    bool is_blocked_below(int index, const glm::vec3& from, const glm::vec3& to) const;

    std::vector<FlatNode> nodes_;
    int root_ = 0;
};

struct LightSource {
    enum class Kind { point, spot, surface } kind = Kind::point;
    dvec3 position { 0 }, normal { 0 };
    dvec3 colour { 1 }; // largest part 1
    double intensity = 0;
    double cone_cosine = 0;
    int style = 0;
    int cluster = -1;
};

// A piece of a face, for emission and bounces.
struct Patch {
    size_t face = 0;
    Bounds bounds;
    dvec3 position { 0 }; // its centre, one unit off the surface
    dvec3 normal { 0 };
    double area = 0;
    int cluster = -1;
    bool absorbs = false; // sky: nothing comes back
    dvec3 emission { 0 }, reflectivity { 0 };
    dvec3 direct { 0 }; // mean of the samples on it, style 0
    int sample_count = 0;
    dvec3 bounced { 0 }; // the result: what arrives by reflection
};

struct LightScene {
    LightScene(const formats::Bsp& map, const SourceMap& source_world);

    const formats::Bsp& bsp;
    const SourceMap& world;
    Occlusion occlusion;
    std::vector<formats::ClusterSet> pvs; // per cluster
    std::vector<dvec3> face_origin; // what a brush model's faces are moved by
    std::vector<Patch> patches; // in the order of the faces
    std::vector<size_t> first_patch; // per face, and one past the end
    std::vector<LightSource> sources;
    std::vector<std::vector<int>> cluster_sources; // per cluster: the sources in its PVS

    std::span<Patch> patches_of(size_t face)
    {
        return std::span(patches).subspan(first_patch[face], first_patch[face + 1] - first_patch[face]);
    }
    bool is_visible(int from_cluster, int to_cluster) const
    {
        return from_cluster >= 0 && pvs[size_t(from_cluster)].contains(to_cluster);
    }
};

// light_sources.cpp
void make_patches(LightScene& scene);
void make_sources(LightScene& scene, const WarningSink& warn);
// radiosity.cpp: fills the patches' `bounced` from their `direct`. Returns the number of patch pairs that see each
// other.
size_t bounce_light(LightScene& scene, unsigned threads);

} // namespace vkpt::tools
