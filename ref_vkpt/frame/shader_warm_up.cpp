// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/shader_warm_up.hpp"

#include "common/hash.hpp"
#include "common/parallel.hpp"
#include "ref_vkpt/engine/errors.hpp"
#include "ref_vkpt/frame/scene_texels.hpp"
#include "ref_vkpt/frame/view_buffers.hpp"
#include "ref_vkpt/vulkan/commands.hpp"
#include "shaders/shared/frame.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <optional>

namespace vkpt {

namespace {

constexpr size_t max_threads = 8; // each holds a device with its own memory

// A device beside the frame's own, that is asked to do nothing by each shader.
class IdleDevice {
public:
    explicit IdleDevice(const Device& original)
        : device_(Device::make_twin(original))
        , uniforms_(gpu_, sizeof(shared::FrameUniforms), BufferHome::upload, MemoryKind::staging, "idle uniforms")
    {
        bindings_.bind_uniforms(uniforms_, uniforms_.size());
    }

    ~IdleDevice() { vkDeviceWaitIdle(device_->handle); }

    void dispatch_nothing(const std::string& shader)
    {
        VKPT_CHECK(vkResetCommandPool(device_->handle, pool_, 0));
        begin_commands(commands_);
        bindings_.bind(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, 0, { scene_texels_.set(0), screen_texels_.handle() });
        constexpr std::array<std::byte, push_constant_bytes> push {};
        vkCmdPushConstants(
            commands_, bindings_.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, push_constant_bytes, push.data());
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.compute(shader));
        vkCmdDispatch(commands_, 0, 1, 1);
        submit_commands(device_->queue, commands_);
        device_->wait_idle();
    }

private:
    std::unique_ptr<Device> device_;
    MemoryAllocator memory_ { *device_ };
    Gpu gpu_ { *device_, memory_ };
    Bindings bindings_ { gpu_ };
    SceneTexels scene_texels_ { gpu_, bindings_ };
    TexelSet screen_texels_ = make_screen_texels(gpu_, bindings_);
    Pipelines pipelines_ { gpu_, bindings_, "" };
    Buffer uniforms_;
    CommandPool pool_ = make_command_pool(*device_, device_->queue_family);
    VkCommandBuffer commands_ = make_command_buffer(*device_, pool_);
};

} // namespace

ShaderWarmUp::ShaderWarmUp(const Device& device, Pipelines& pipelines, std::vector<std::string> shaders)
    : device_(device)
    , pipelines_(pipelines)
    , shaders_(std::move(shaders))
{
    const std::string directory = device.driver_cache_directory();
    if (device.traits.keeps_compiled_shaders && !directory.empty() && !std::getenv("MESA_SHADER_CACHE_DISABLE")) {
        compiled_file_ = directory + "/compiled.txt";
        read_compiled();
    }
    for (size_t i = 0; i < std::min({ size_t(core_count()), max_threads, shaders_.size() }); i++)
        threads_.emplace_back([this] { run_thread(); });
}

ShaderWarmUp::~ShaderWarmUp()
{
    next_ = shaders_.size();
    wait();
}

void ShaderWarmUp::wait()
{
    for (std::thread& thread : threads_)
        thread.join();
    threads_.clear();
}

// What fails here fails again, and is told, when the frame asks for it.
void ShaderWarmUp::run_thread()
try {
    std::optional<IdleDevice> idle_device;
    for (size_t i = next_++; i < shaders_.size(); i = next_++) {
        const std::string& shader = shaders_[i];
        const std::string key = key_of(shader);
        if (!compiled_file_.empty() && !is_compiled(key)) {
            if (!idle_device)
                idle_device.emplace(device_);
            idle_device->dispatch_nothing(shader);
            add_compiled(key);
        }
        pipelines_.compute(shader);
    }
} catch (const std::exception&) {
}

// Of the code, what specialises it, and the driver's version.
std::string ShaderWarmUp::key_of(const std::string& shader) const
{
    const uint64_t driver = hash_bytes(std::as_bytes(std::span(device_.driver)));
    return fmt::format(
        "{} {:016x} {}", shader, hash_bytes(std::as_bytes(find_shader(shader)), driver), device_.table_reads());
}

void ShaderWarmUp::read_compiled()
{
    std::ifstream file(compiled_file_);
    for (std::string line; std::getline(file, line);)
        compiled_.insert(line);
}

bool ShaderWarmUp::is_compiled(const std::string& key)
{
    const std::scoped_lock lock(mutex_);
    return compiled_.contains(key);
}

void ShaderWarmUp::add_compiled(const std::string& key)
{
    const std::scoped_lock lock(mutex_);
    compiled_.insert(key);
    std::ofstream(compiled_file_, std::ios::app) << key << '\n'; // one that cannot be written is done without
}

} // namespace vkpt
