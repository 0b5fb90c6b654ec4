// SPDX-License-Identifier: GPL-2.0-or-later
// A map as the renderer sees it: triangles, materials and emitters of the world and of its brush models. Nothing of it
// changes once it is loaded. No Vulkan in here.
#pragma once

#include "formats/bsp.hpp"
#include "formats/camera_file.hpp"
#include "ref_vkpt/lights/animated_lights.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/light_cache.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "ref_vkpt/lights/suns.hpp"
#include "ref_vkpt/rays/bvh.hpp"
#include "ref_vkpt/scene/brush_mesh.hpp"
#include "shaders/shared/scene.h"
#include "shaders/shared/trace.h"

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace vkpt {

// Rows of the lightstyle table: the engine's 256, then these.
inline constexpr uint32_t lightstyle_dlight = 256; // engine dlights, scaled by pt_dlight_scale
inline constexpr uint32_t lightstyle_sky = 257; // sky faces, scaled by pt_sky_scale
inline constexpr uint32_t lightstyle_sun = 258; // suns without a lightstyle of their own
inline constexpr uint32_t lightstyle_none = 259; // always 0: what does not shine of a face that glows in parts
inline constexpr uint32_t lightstyle_count = 260; // and then those of World::animated_lights

// Geometry of the world (model 0) or of a brush model, in model space.
struct MapGeometry {
    std::vector<shared::Triangle> triangles; // material = texinfo; emitter = index into `emitters`
    std::vector<uint32_t> masks; // MASK_* per triangle
    std::vector<uint8_t> has_holes; // per triangle, 1: the alpha of one of its textures decides what is met
    std::vector<shared::Emitter> emitters;
    std::vector<shared::FilterBox> filter_boxes; // around what colours light, at most MAX_FILTER_BOXES
    bool has_alpha_test = false;
};

using FindFaceTexture = std::function<FaceTexture(const std::string& texture)>; // by texinfo texture name

class MaterialLibrary;
struct MaterialSettings;

struct MaterialDefaults {
    float roughness = 0.7f, metallic = 0;
    const MaterialLibrary* materials = nullptr; // go before guesses
    float bump_scale = 1; // of all normal maps

    // Of a material_name(); nullptr: nothing is said of that texture.
    const MaterialSettings* find(std::string_view name) const;
};

// The software backend's, in one array of nodes and one of triangles.
struct WorldTrees {
    Bvh bvh; // of all triangles: its root is node 0
    uint32_t filter_root = shared::BVH_NO_CHILD; // of those that colour light (MASK_FILTER) alone, once more; or none
};

struct World {
    std::string name;
    formats::Bsp bsp;
    std::vector<MapGeometry> models; // 0: the world
    std::vector<BrushMesh> brush_meshes; // of `models`; [0] is empty
    std::vector<FaceTexture> textures; // per texinfo
    FaceTriangles faces;
    std::vector<std::string> material_names; // per texinfo
    std::vector<glm::vec3> emission; // per texinfo: Material::emission
    std::vector<uint32_t> media; // per texinfo: MEDIUM_* that its faces bound
    std::vector<shared::FogBox> fog_boxes; // at most MAX_FOG_BOXES
    std::vector<Sun> suns;
    std::vector<formats::SecurityCamera> cameras;
    AnimatedLights animated_lights { lightstyle_count };
    LightLists light_lists; // of the map's own emitters
    LightCacheLayout light_cache;
    // Of model 0: made on a thread of its own while textures and models are read.
    const WorldTrees& trees() const { return trees_future.get(); }
    std::shared_future<WorldTrees> trees_future; // behind `models`, which it reads
    // Mean luminance of the sky faces that the map's author gave a light value; 0: none. Their sky is as bright as
    // that.
    float lit_sky_luminance = 0;
    std::vector<std::string> messages; // what could not be used; for the console

    // The materials of a moment: [0, n) animate with time; [n, 2n) show each texinfo's own texture, for brush models
    // that choose their texture by frame (see animation_frame).
    std::vector<shared::Material> make_materials(float time, const MaterialDefaults& defaults) const;
    size_t material_count() const { return bsp.texinfos.size() * 2; }
    // The material that a brush model's frame shows in place of texinfo material `texinfo`.
    uint32_t animation_frame(uint32_t texinfo, int frame) const;
};

// Reads and prepares maps/NAME.bsp. Throws formats::FormatError.
// `more_entities`: entity text that counts as if it stood behind the map's own.
std::unique_ptr<World> load_world(formats::Bytes file, const std::string& name, const FindFaceTexture& find_texture,
    const EmissionScales& scales, std::string_view more_entities = {});

// Sets what sky emitters are expected to send, once the sky is known: the average of its textures.
void set_sky_radiance(World& world, glm::vec3 average);

} // namespace vkpt
