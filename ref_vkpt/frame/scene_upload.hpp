// SPDX-License-Identifier: GPL-2.0-or-later
// Brings the scene to the device: triangles, trees, emitters, light lists. What stays the same from frame to frame
// stays there.
#pragma once

#include "ref_vkpt/frame/gpu_world.hpp"
#include "ref_vkpt/frame/graphics.hpp"
#include "ref_vkpt/frame/packed_light_upload.hpp"
#include "ref_vkpt/frame/scene_texels.hpp"
#include "ref_vkpt/frame/uploads.hpp"
#include "ref_vkpt/rays/acceleration_structures.hpp"
#include "ref_vkpt/rays/backend.hpp"
#include "ref_vkpt/scene/snapshot.hpp"

#include <cstdint>
#include <deque>

namespace vkpt {

class SceneUpload {
public:
    SceneUpload(Graphics& graphics, Workers& workers);

    // The device has finished the slot's last frame.
    void begin_frame();
    struct Use {
        VkCommandBuffer commands = VK_NULL_HANDLE; // for copies and builds
        uint32_t view_number = 0; // in the frame
        TraceBackend backend = TraceBackend::software;
        VkDeviceAddress trace_stack = 0;
        bool finds_reprojected = false; // primary_visibility asks where moving things were in the last view
    };
    // `gpu_world` belongs to scene.world. Returns descriptor set 2.
    VkDescriptorSet fill(shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, const Use& use);
    // Memory of the frame that is recorded.
    FrameUploads& uploads() { return uploads_; }
    // The map has gone; the device is idle.
    void forget_world() { structures_.forget_world(); }
    // Bytes of the map's acceleration structure per triangle.
    double bytes_per_triangle(const World& world, TraceBackend backend) const;

private:
    // What the device keeps for the views of this number in the frame; little of it is written in each.
    struct Kept {
        Kept(const Gpu& gpu, const Bindings& bindings);
        SceneTexels texels;
        PrefixedUpload triangles, emitters, tree_nodes, tree_triangles;
        PackedLightUpload packed_lights;
        KeptUpload materials, light_lists, dynamic_light_indices;
    };
    // One call of fill().
    struct Job {
        shared::SceneView& out;
        const SceneSnapshot& scene;
        const GpuWorld* gpu_world;
        const Use& use;
        Kept& kept;
        uint64_t version; // of the map's data
    };
    MovingTarget reserve_moving(const Job& job);
    void fill_emitters(const Job& job);
    void fill_light_lists(const Job& job);
    void write_trees(const Job& job, MovingTarget target);
    void write_structures(const Job& job, const MovingTarget& target);
    void bind_texels(const Job& job);
    void record_copies(const Job& job);

    Graphics& graphics_;
    FrameUploads uploads_;
    std::deque<Kept> kept_; // by view_number; each stays where it is
    MovingWriter moving_writer_;
    AccelerationStructures structures_;
};

} // namespace vkpt
