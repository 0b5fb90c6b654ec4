// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of the module that talk to Vulkan, as far as scene update and 2D need them, without any: images and
// buffers are kept or dropped on the CPU. Everything above (textures.cpp, scene.cpp, draw2d.cpp ...) is the module's
// own.
#include "ref_vkpt/draw2d/draw2d.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <memory>
#include <utility>

// What handles call: there is nothing to destroy.
namespace {
template <class Handle> void VKAPI_PTR forget(VkDevice, Handle, const VkAllocationCallbacks*) { }
}
#define FORGET(type) PFN_vkDestroy##type vkDestroy##type = forget<Vk##type>;
FORGET(Buffer)
FORGET(CommandPool)
FORGET(DescriptorPool)
FORGET(DescriptorSetLayout)
FORGET(Fence)
FORGET(Image)
FORGET(ImageView)
FORGET(PipelineLayout)
FORGET(Sampler)
#undef FORGET

namespace vkpt {

ScopedVariable::~ScopedVariable() = default; // there is none

Device::Device(const DeviceSettings&)
    : windowed_(false)
    , uses_rays_(false)
{
    properties.limits.maxImageDimension2D = 4096;
    max_textures = 512;
}
Device::~Device() = default;

// ---- memory: a block for each piece

MemoryAllocator::MemoryAllocator(const Device& device)
    : device_(device)
{
}
MemoryAllocator::~MemoryAllocator() = default;

Allocation MemoryAllocator::allocate(const VkMemoryRequirements& requirements, const MemoryWish&, bool, MemoryKind)
{
    Allocation piece;
    piece.allocator_ = this;
    piece.block_ = new MemoryBlock;
    piece.block_->mapped = new std::byte[requirements.size];
    piece.size_ = requirements.size;
    return piece;
}
Allocation::~Allocation()
{
    if (!block_)
        return;
    delete[] block_->mapped;
    delete block_;
}
void* Allocation::mapped() const { return block_->mapped; }
void Allocation::swap(Allocation& other) noexcept
{
    std::swap(allocator_, other.allocator_);
    std::swap(block_, other.block_);
    std::swap(offset_, other.offset_);
    std::swap(size_, other.size_);
    std::swap(kind_, other.kind_);
}

Buffer::Buffer(const Gpu& gpu, VkDeviceSize size, BufferHome, MemoryKind kind, std::string_view)
    : size_(size)
{
    VkMemoryRequirements requirements {};
    requirements.size = size;
    allocation_ = gpu.memory.allocate(requirements, {}, true, kind);
}

Image::Image(const Gpu&, const ImageSettings& settings, std::string_view)
    : settings_(settings)
{
    static uint64_t count = 0;
    handle_ = { VK_NULL_HANDLE, VkImage(++count) };
}

// ---- what is told to the device

Bindings::Bindings(const Gpu& gpu)
    : gpu_(gpu)
    , max_textures_(gpu.device.max_textures)
{
}
uint32_t Bindings::add_texture(const Image&)
{
    if (free_slots_.empty())
        return next_slot_++;
    const uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    return slot;
}
void Bindings::remove_texture(uint32_t slot) { free_slots_.push_back(slot); }

Uploader::Uploader(const Gpu& gpu)
    : gpu_(gpu)
{
}
Uploader::~Uploader() = default;
void Uploader::fill_image(const Image&, uint32_t, std::span<const std::byte>) { }
void Uploader::flush() { }

// ---- 2D: quads are collected and forgotten

Draw2d::Draw2d(
    const Gpu& gpu, Bindings& bindings, Pipelines& pipelines, TextureStore& textures, uint32_t frames_in_flight)
    : gpu_(gpu)
    , bindings_(bindings)
    , textures_(textures)
    , pipelines_(pipelines)
    , frames_(frames_in_flight)
{
}
Draw2d::~Draw2d() = default;
void Draw2d::set_output(VkDeviceAddress words, VkExtent2D size)
{
    output_ = words;
    size_ = size;
}
void Draw2d::record(VkCommandBuffer)
{
    quads_.clear();
    raw_copies_.clear();
}

} // namespace vkpt
