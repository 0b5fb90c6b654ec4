// SPDX-License-Identifier: GPL-2.0-or-later
// The scene in the driver's acceleration structures, for the trace backends "query" and "pipeline": bottom levels for
// the map's triangles, built once, and for what moves, rebuilt for every view; a top level per view.
#pragma once

#include "ref_vkpt/rays/triangle_groups.hpp"
#include "ref_vkpt/vulkan/acceleration_structure.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

namespace vkpt {

class AccelerationStructures {
public:
    // The device has its own ray tracing.
    explicit AccelerationStructures(const Gpu& gpu)
        : gpu_(gpu)
    {
    }

    // Builds the map's structures and waits for them; the device is idle. `version`: of the map, see holds_world.
    void build_world(const GroupedTriangles& world, uint64_t version, Uploader& uploader);
    bool holds_world(uint64_t version) const { return world_.version == version; }
    // Gives the map's memory back; the device is idle.
    void forget_world() { world_ = {}; }
    // Bytes of the map's structures per triangle; 0: there is no map.
    double world_bytes_per_triangle() const;

    // The device has finished the last frame with this slot.
    void begin_frame(uint32_t slot);

    // What shaders need to know, see shared::SceneView.
    struct View {
        VkDeviceAddress structure = 0;
        VkDeviceAddress ids[2] {};
    };
    // Records the structures of one view; shaders recorded after it may trace.
    View record_view(VkCommandBuffer commands, const GroupedTriangles& moving, bool with_world);

private:
    struct WorldStructure {
        uint64_t version = 0;
        std::vector<AccelerationStructure> structures; // per group
        std::vector<TriangleGroup> groups;
        Buffer ids;
        VkDeviceSize bytes = 0;
    };
    // A structure that is rebuilt from ever changing triangles.
    struct Rebuilt {
        AccelerationStructure structure;
        uint32_t capacity = 0; // triangles or instances
        VkDeviceSize scratch_bytes = 0;
    };
    struct ViewMemory {
        Buffer corners, ids, instances, scratch;
        std::map<uint32_t, Rebuilt> groups; // by mask and holes
        Rebuilt top;
    };
    ViewMemory& next_view();
    void fit(Rebuilt& rebuilt, uint32_t count, VkAccelerationStructureTypeKHR type, bool has_holes);
    VkDeviceAddress fit_scratch(ViewMemory& memory, VkDeviceSize bytes);
    void build_groups(VkCommandBuffer commands, ViewMemory& memory, const GroupedTriangles& moving);
    void build_top(VkCommandBuffer commands, ViewMemory& memory, uint32_t instance_count);

    Gpu gpu_;
    WorldStructure world_;
    std::array<std::deque<ViewMemory>, frames_in_flight> views_; // per slot, one for each view of the frame
    uint32_t slot_ = 0;
    size_t views_this_frame_ = 0;
};

} // namespace vkpt
