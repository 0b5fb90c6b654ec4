// SPDX-License-Identifier: GPL-2.0-or-later
// Vulkan's ray masks belong to instances and its opacity to geometries, so each combination of the two that occurs is a
// bottom level of its own (triangle_groups.hpp) and one instance of the top level, at the identity: triangles are in
// world space.
#include "ref_vkpt/rays/acceleration_structures.hpp"

#include "shaders/shared/trace.h"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

constexpr VkBuildAccelerationStructureFlagsKHR flags_world = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
constexpr VkBuildAccelerationStructureFlagsKHR flags_moving = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
constexpr VkPipelineStageFlags build_stage = VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
constexpr VkAccessFlags structure_write = VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
constexpr VkAccessFlags structure_read = VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR;

constexpr uint32_t table_world = 0, table_moving = 1;

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

// One geometry and what its build is told. Not movable: the info points at the geometry.
struct Build {
    VkAccelerationStructureGeometryKHR geometry { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR };
    VkAccelerationStructureBuildGeometryInfoKHR info {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR
    };
    VkAccelerationStructureBuildRangeInfoKHR range {};
    uint32_t count = 0; // primitives

    Build(VkAccelerationStructureTypeKHR type, VkBuildAccelerationStructureFlagsKHR flags, uint32_t primitives)
        : count(primitives)
    {
        range.primitiveCount = primitives;
        info.type = type;
        info.flags = flags;
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
        info.geometryCount = 1;
        info.pGeometries = &geometry;
    }
    Build(const Build&) = delete;

    VkAccelerationStructureBuildSizesInfoKHR sizes(VkDevice device, uint32_t capacity) const
    {
        VkAccelerationStructureBuildSizesInfoKHR sizes {
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR
        };
        vkGetAccelerationStructureBuildSizesKHR(
            device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &capacity, &sizes);
        return sizes;
    }
    void record(VkCommandBuffer commands, const AccelerationStructure& target, VkDeviceAddress scratch)
    {
        info.dstAccelerationStructure = target.handle();
        info.scratchData.deviceAddress = scratch;
        const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
        vkCmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
    }
};

// Every triangle has corners of its own: there is no index buffer.
void set_triangles(Build& build, VkDeviceAddress corners, bool has_holes)
{
    build.geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    // The driver may ask about one hole more than once: the answer is the same.
    build.geometry.flags = has_holes ? 0 : VK_GEOMETRY_OPAQUE_BIT_KHR;
    VkAccelerationStructureGeometryTrianglesDataKHR& data = build.geometry.geometry.triangles;
    data = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR };
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = corners;
    data.vertexStride = sizeof(glm::vec3);
    data.maxVertex = std::max(build.count * 3, 1u) - 1;
    data.indexType = VK_INDEX_TYPE_NONE_KHR;
}

void set_instances(Build& build, VkDeviceAddress instances)
{
    build.geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    VkAccelerationStructureGeometryInstancesDataKHR& data = build.geometry.geometry.instances;
    data = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR };
    data.data.deviceAddress = instances;
}

VkDeviceAddress corners_of(const Buffer& corners, const TriangleGroup& group)
{
    return corners.address() + VkDeviceSize(group.first) * 3 * sizeof(glm::vec3);
}

VkAccelerationStructureInstanceKHR make_instance(
    const TriangleGroup& group, uint32_t table, const AccelerationStructure& structure)
{
    VkAccelerationStructureInstanceKHR instance {};
    for (int i = 0; i < 3; i++)
        instance.transform.matrix[i][i] = 1;
    instance.instanceCustomIndex = (table << shared::STRUCTURE_TABLE_SHIFT | group.first) & 0xffffffu;
    instance.mask = group.mask & 0xffu;
    // Both sides are met. Vulkan's default front is ours: clockwise where its rays' space, unlike ours, is left-handed.
    instance.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR & 0xffu;
    instance.accelerationStructureReference = structure.address();
    return instance;
}

uint32_t key_of(const TriangleGroup& group) { return group.mask << 1 | uint32_t(group.has_holes); }

void write(Buffer& buffer, const Gpu& gpu, std::span<const std::byte> bytes, std::string_view name)
{
    if (bytes.size() > buffer.size() || !buffer) {
        buffer = Buffer();
        buffer
            = Buffer(gpu, bytes.size() + bytes.size() / 2 + 4096, BufferHome::upload, MemoryKind::acceleration, name);
    }
    if (!bytes.empty())
        std::memcpy(buffer.mapped(), bytes.data(), bytes.size());
}

// A build reads what builds before it wrote, and may take their scratch memory.
void record_build_barrier(VkCommandBuffer commands)
{
    record_memory_barrier(commands, build_stage, structure_write, build_stage, structure_read | structure_write);
}

} // namespace

void AccelerationStructures::build_world(const GroupedTriangles& world, uint64_t version, Uploader& uploader)
{
    world_ = {};
    const VkDeviceSize before = gpu_.memory.bytes_in_use(MemoryKind::acceleration);
    const Buffer corners = uploader.make_buffer(world.corners, MemoryKind::staging, "world corners");
    world_.ids = uploader.make_buffer(world.ids, MemoryKind::acceleration, "world triangle ids");
    uploader.flush();
    std::vector<Buffer> scratch;
    for (const TriangleGroup& group : world.groups) {
        Build build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, flags_world, group.count);
        set_triangles(build, corners_of(corners, group), group.has_holes);
        const auto sizes = build.sizes(gpu_.device.handle, group.count);
        const AccelerationStructure& target = world_.structures.emplace_back(
            gpu_, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, sizes.accelerationStructureSize, "world structure");
        const Buffer& room = scratch.emplace_back(gpu_, sizes.buildScratchSize + gpu_.device.scratch_alignment,
            BufferHome::device, MemoryKind::staging, "world structure's scratch");
        build.record(uploader.commands(), target, align_up(room.address(), gpu_.device.scratch_alignment));
    }
    if (!world.groups.empty())
        record_memory_barrier(uploader.commands(), build_stage, structure_write,
            build_stage | gpu_.device.shader_stages(), structure_read);
    uploader.flush();
    world_.groups = world.groups;
    world_.version = version;
    world_.bytes = gpu_.memory.bytes_in_use(MemoryKind::acceleration) - before;
}

double AccelerationStructures::world_bytes_per_triangle() const
{
    uint32_t count = 0;
    for (const TriangleGroup& group : world_.groups)
        count += group.count;
    return count > 0 ? double(world_.bytes) / count : 0;
}

void AccelerationStructures::begin_frame(uint32_t slot)
{
    slot_ = slot;
    views_this_frame_ = 0;
}

AccelerationStructures::ViewMemory& AccelerationStructures::next_view()
{
    std::deque<ViewMemory>& views = views_[slot_];
    if (views_this_frame_ == views.size())
        views.emplace_back();
    return views[views_this_frame_++];
}

void AccelerationStructures::fit(Rebuilt& rebuilt, uint32_t count, VkAccelerationStructureTypeKHR type, bool has_holes)
{
    if (rebuilt.structure && count <= rebuilt.capacity)
        return;
    rebuilt.capacity = count + count / 2 + 16;
    Build build(type, flags_moving, rebuilt.capacity);
    if (type == VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR)
        set_instances(build, 0);
    else
        set_triangles(build, 0, has_holes);
    const auto sizes = build.sizes(gpu_.device.handle, rebuilt.capacity);
    rebuilt.structure = AccelerationStructure();
    rebuilt.structure = AccelerationStructure(gpu_, type, sizes.accelerationStructureSize, "moving structure");
    rebuilt.scratch_bytes = align_up(sizes.buildScratchSize, gpu_.device.scratch_alignment);
}

VkDeviceAddress AccelerationStructures::fit_scratch(ViewMemory& memory, VkDeviceSize bytes)
{
    const VkDeviceSize needed = bytes + gpu_.device.scratch_alignment;
    if (!memory.scratch || memory.scratch.size() < needed) {
        memory.scratch = Buffer();
        memory.scratch = Buffer(
            gpu_, needed + needed / 2, BufferHome::device, MemoryKind::acceleration, "moving structures' scratch");
    }
    return align_up(memory.scratch.address(), gpu_.device.scratch_alignment);
}

void AccelerationStructures::build_groups(VkCommandBuffer commands, ViewMemory& memory, const GroupedTriangles& moving)
{
    VkDeviceSize scratch_bytes = 0;
    for (const TriangleGroup& group : moving.groups) {
        Rebuilt& rebuilt = memory.groups[key_of(group)];
        fit(rebuilt, group.count, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, group.has_holes);
        scratch_bytes += rebuilt.scratch_bytes;
    }
    fit(memory.top, uint32_t(world_.groups.size() + moving.groups.size()), VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
        false);
    VkDeviceAddress scratch = fit_scratch(memory, std::max(scratch_bytes, memory.top.scratch_bytes));
    for (const TriangleGroup& group : moving.groups) {
        const Rebuilt& rebuilt = memory.groups[key_of(group)];
        Build build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, flags_moving, group.count);
        set_triangles(build, corners_of(memory.corners, group), group.has_holes);
        build.record(commands, rebuilt.structure, scratch);
        scratch += rebuilt.scratch_bytes;
    }
}

void AccelerationStructures::build_top(VkCommandBuffer commands, ViewMemory& memory, uint32_t instance_count)
{
    record_build_barrier(commands);
    Build build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, flags_moving, instance_count);
    set_instances(build, memory.instances.address());
    build.record(commands, memory.top.structure, align_up(memory.scratch.address(), gpu_.device.scratch_alignment));
    record_memory_barrier(commands, build_stage, structure_write, gpu_.device.shader_stages(), structure_read);
}

AccelerationStructures::View AccelerationStructures::record_view(
    VkCommandBuffer commands, const GroupedTriangles& moving, bool with_world)
{
    ViewMemory& memory = next_view();
    write(memory.corners, gpu_, std::as_bytes(std::span(moving.corners)), "moving corners");
    write(memory.ids, gpu_, std::as_bytes(std::span(moving.ids)), "moving triangle ids");
    build_groups(commands, memory, moving);

    std::vector<VkAccelerationStructureInstanceKHR> instances;
    for (size_t i = 0; with_world && i < world_.groups.size(); i++)
        instances.push_back(make_instance(world_.groups[i], table_world, world_.structures[i]));
    for (const TriangleGroup& group : moving.groups)
        instances.push_back(make_instance(group, table_moving, memory.groups[key_of(group)].structure));
    write(memory.instances, gpu_, std::as_bytes(std::span(instances)), "instances");
    build_top(commands, memory, uint32_t(instances.size()));

    View view;
    view.structure = memory.top.structure.address();
    view.ids[table_world] = with_world ? world_.ids.address() : memory.ids.address();
    view.ids[table_moving] = memory.ids.address();
    return view;
}

} // namespace vkpt
