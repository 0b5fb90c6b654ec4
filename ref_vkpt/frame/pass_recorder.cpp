// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/pass_recorder.hpp"

#include <cassert>

namespace vkpt {

void PassRecorder::begin(VkCommandBuffer commands, const ShaderChoice& choice)
{
    commands_ = commands;
    choice_ = choice;
    read_ = written_ = 0;
}

void PassRecorder::wait_for_what_it_uses(const Pass& pass)
{
    if ((pass.read_memory & written_) || (pass.written_memory & (read_ | written_))) {
        const VkPipelineStageFlags shaders = graphics_.device.shader_stages();
        record_memory_barrier(commands_, shaders, VK_ACCESS_SHADER_WRITE_BIT, shaders,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
        read_ = written_ = 0;
    }
    read_ |= pass.read_memory;
    written_ |= pass.written_memory;
}

void PassRecorder::dispatch(const Pass& pass, const PassWork& work)
{
    const std::string shader = shader_of(pass, choice_);
    if (is_ray_pipeline(pass, choice_)) {
        const RayPipeline& pipeline = graphics_.pipelines.ray(shader);
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline.handle);
        vkCmdTraceRaysKHR(commands_, &pipeline.generation, &pipeline.miss, &pipeline.hit, &pipeline.callable,
            work.size.x, work.size.y, 1);
    } else {
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, graphics_.pipelines.compute(shader));
        const glm::uvec2 groups
            = work.groups > 0 ? glm::uvec2(work.groups, 1) : pixel_groups(graphics_.device, work.size);
        vkCmdDispatch(commands_, groups.x, groups.y, 1);
    }
}

void PassRecorder::record(const Pass& pass, const PassStep& step)
{
    assert(step.push_bytes == pass.push_bytes);
    wait_for_what_it_uses(pass);
    const DebugLabel label(graphics_.device, commands_, pass.name);
    if (step.push_bytes > 0)
        vkCmdPushConstants(
            commands_, graphics_.bindings.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, step.push_bytes, step.push.data());
    graphics_.markers.begin_pass(commands_, pass.name);
    dispatch(pass, step.work);
    graphics_.timer.mark(commands_, pass.name);
}

} // namespace vkpt
