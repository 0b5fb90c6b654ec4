// SPDX-License-Identifier: GPL-2.0-or-later
// A map as the module loads it: read, triangulated, its emitters, light lists, multisets and trees, the tree of its
// triangles; then a frame's work on it: moving lights and materials.
#include "fuzz/support/harness.hpp"
#include "ref_vkpt/lights/light_multisets.hpp"
#include "ref_vkpt/lights/light_trees.hpp"
#include "ref_vkpt/lights/packed_lights.hpp"
#include "ref_vkpt/lights/view_lights.hpp"
#include "ref_vkpt/rays/triangle_groups.hpp"
#include "ref_vkpt/scene/lightmaps.hpp"
#include "ref_vkpt/scene/world.hpp"

namespace {

using namespace vkpt;

// Textures by the texture's name, so that an input says all: missing, dark, shining all over or in parts, of any size.
FaceTexture find_texture(const std::string& texture)
{
    uint32_t hash = 1;
    for (const char c : texture)
        hash = hash * 31 + uint8_t(c);
    FaceTexture found;
    found.size = { 1 << (hash % 11), 1 << (hash / 11 % 11) };
    found.missing = hash % 5 == 0;
    if (hash % 7 == 0)
        found.average = glm::vec3(0);
    if (hash % 2 == 0)
        found.parts = { { { 0.25f, 0.25f }, { 0.5f, 0.75f }, glm::vec3(1) },
            { { 0.75f, 0 }, { 1, 1 }, glm::vec3(1, 0.5f, 0) } };
    return found;
}

void check_lights(World& world)
{
    const std::vector<shared::Emitter>& emitters = world.models[0].emitters;
    const LightLists& lists = world.light_lists;
    for (const uint32_t index : lists.static_indices())
        fuzz::require(index < emitters.size(), "light lists hold emitters that there are");
    const LightMultisets multisets = make_light_multisets(world.bsp, world.faces, lists, emitters);
    for (const uint32_t index : multisets.entries)
        fuzz::require((index & ((1u << shared::LIGHT_COPIES_SHIFT) - 1)) < emitters.size(),
            "multisets hold emitters that there are");
    const LightTrees trees = make_light_trees(lists.lists(), lists.static_indices(), emitters);
    fuzz::require(trees.lights.size() == lists.static_indices().size(), "a tree has all lights of its list");
    std::vector<shared::PackedLight> packed_lights(emitters.size());
    std::vector<float> styles(lightstyle_count, 1.0f);
    world.animated_lights.append_rows(styles, 0);
    write_packed_lights(packed_lights.data(), packed_lights.size(), emitters, styles);
}

void move_lights(const World& world)
{
    const formats::BspModel& whole = world.bsp.models[0];
    ViewLights lights { {}, world.light_lists };
    for (const float share : { 0.1f, 0.5f }) {
        const glm::vec3 place = whole.mins + (whole.maxs - whole.mins) * share;
        std::vector<shared::Emitter> moving { make_dynamic_light(place, { 1, 0.5f, 0 }, 300) };
        moving[0].lightstyle = lightstyle_dlight;
        lights.dynamic.arrange(moving);
        lights.lists.update(moving);
        fuzz::use(lights.lists.repeat());
        fuzz::use(world.bsp.find_cluster(place));
    }
}

void use_world(World& world)
{
    set_sky_radiance(world, { 0.5f, 0.6f, 0.7f });
    check_lights(world);
    move_lights(world);
    fuzz::use(world.make_materials(1.5f, {}));
    const Lightmaps lightmaps = read_lightmaps(world);
    for (const shared::LightmapFace& map : lightmaps.faces)
        fuzz::require(map.first + size_t(map.size & 0xffff) * (map.size >> 16) <= lightmaps.luxels.size(),
            "a face's lightmap is among the luxels");
    const MapGeometry& geometry = world.models[0];
    const TriangleSource source { geometry.triangles, geometry.masks, geometry.has_holes, 0 };
    fuzz::use(group_triangles(source, TriangleOrder::halves_best));
    const auto filters = std::ranges::count_if(geometry.masks, [](uint32_t m) { return m & shared::MASK_FILTER; });
    fuzz::require(world.trees().bvh.triangle_count <= geometry.triangles.size() + size_t(filters),
        "trees have no more triangles than their map");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    try {
        const auto world = load_world(fuzz::bytes_of(data, size), "maps/input.bsp", find_texture, {});
        use_world(*world);
    } catch (const formats::FormatError&) {
    }
    return 0;
}
