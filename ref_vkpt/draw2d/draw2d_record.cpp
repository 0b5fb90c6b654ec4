// SPDX-License-Identifier: GPL-2.0-or-later
// The device's side of the 2D layer: pipeline, memory of the frames in flight, command recording.
#include "ref_vkpt/draw2d/draw2d.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

constexpr VkFormat output_format = VK_FORMAT_R8G8B8A8_UNORM;
constexpr uint32_t vertices_per_quad = 6;
// A console full of text at 1080p is about 20,000 characters.
constexpr VkDeviceSize smallest_quad_memory = 4096 * sizeof(shared::Quad);

// Everything that may use the output picture before or after the 2D layer.
constexpr VkPipelineStageFlags other_stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT
    | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT
    | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkAccessFlags other_writes
    = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags other_reads
    = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT;

VkPipelineShaderStageCreateInfo make_stage(VkShaderStageFlagBits stage, VkShaderModule module)
{
    VkPipelineShaderStageCreateInfo info { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO };
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    return info;
}

VkPipelineColorBlendAttachmentState blend_straight_alpha()
{
    VkPipelineColorBlendAttachmentState blend {};
    blend.blendEnable = VK_TRUE;
    blend.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorBlendOp = VK_BLEND_OP_ADD;
    blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.alphaBlendOp = VK_BLEND_OP_ADD;
    blend.colorWriteMask
        = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    return blend;
}

} // namespace

Draw2d::Draw2d(
    const Gpu& gpu, Bindings& bindings, Pipelines& pipelines, TextureStore& textures, uint32_t frames_in_flight)
    : gpu_(gpu)
    , bindings_(bindings)
    , textures_(textures)
    , frames_(frames_in_flight)
{
    create_render_pass();
    create_pipeline(pipelines);
}

Draw2d::~Draw2d()
{
    const VkDevice device = gpu_.device.handle;
    vkDeviceWaitIdle(device);
    for (const RawPicture& picture : raw_pictures_)
        bindings_.remove_texture(picture.slot);
    for (const FrameMemory& frame : frames_)
        for (const RawPicture& picture : frame.retired_pictures)
            bindings_.remove_texture(picture.slot);
    vkDestroyFramebuffer(device, framebuffer_, nullptr);
    vkDestroyPipeline(device, pipeline_, nullptr);
    vkDestroyRenderPass(device, render_pass_, nullptr);
}

void Draw2d::create_render_pass()
{
    VkAttachmentDescription output {};
    output.format = output_format;
    output.samples = VK_SAMPLE_COUNT_1_BIT;
    output.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    output.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    output.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    output.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    output.initialLayout = output.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    const VkAttachmentReference reference { 0, VK_IMAGE_LAYOUT_GENERAL };
    VkSubpassDescription subpass {};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info { VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO };
    info.attachmentCount = 1;
    info.pAttachments = &output;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VKPT_CHECK(vkCreateRenderPass(gpu_.device.handle, &info, nullptr, &render_pass_));
}

void Draw2d::create_pipeline(Pipelines& pipelines)
{
    const VkShaderModule vertex = pipelines.make_module("draw_quads.vert");
    const VkShaderModule fragment = pipelines.make_module("draw_quads.frag");
    const VkPipelineShaderStageCreateInfo stages[]
        = { make_stage(VK_SHADER_STAGE_VERTEX_BIT, vertex), make_stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment) };

    const VkPipelineVertexInputStateCreateInfo no_vertices {
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO
    };
    VkPipelineInputAssemblyStateCreateInfo assembly { VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO };
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport { VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO };
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster { VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO };
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples { VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO };
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const VkPipelineColorBlendAttachmentState attachment = blend_straight_alpha();
    VkPipelineColorBlendStateCreateInfo blend { VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO };
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    const VkDynamicState dynamic_states[] = { VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR };
    VkPipelineDynamicStateCreateInfo dynamic { VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO };
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamic_states;

    VkGraphicsPipelineCreateInfo info { VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO };
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &no_vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = bindings_.pipeline_layout();
    info.renderPass = render_pass_;
    const VkDevice device = gpu_.device.handle;
    const VkResult result = vkCreateGraphicsPipelines(device, pipelines.cache(), 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device, vertex, nullptr);
    vkDestroyShaderModule(device, fragment, nullptr);
    check_vulkan(result, "vkCreateGraphicsPipelines");
    gpu_.device.name_object(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline_), "draw_quads");
}

void Draw2d::set_output(const Image& image)
{
    const VkDevice device = gpu_.device.handle;
    vkDestroyFramebuffer(device, framebuffer_, nullptr);
    framebuffer_ = VK_NULL_HANDLE;
    size_ = { image.width(), image.height() };
    const VkImageView view = image.view();
    VkFramebufferCreateInfo info { VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO };
    info.renderPass = render_pass_;
    info.attachmentCount = 1;
    info.pAttachments = &view;
    info.width = size_.width;
    info.height = size_.height;
    info.layers = 1;
    VKPT_CHECK(vkCreateFramebuffer(device, &info, nullptr, &framebuffer_));
}

void Draw2d::record(VkCommandBuffer commands)
{
    if (quads_.empty() || !framebuffer_)
        return;
    record_raw_copies(commands);
    record_memory_barrier(commands, other_stages, other_writes, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    record_quads(commands, upload_quads());
    record_memory_barrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
        other_stages, other_writes | other_reads);
    quads_.clear();
}

// Appends to what this frame has used already; a buffer that is too small stays alive until the frame is done.
VkDeviceAddress Draw2d::upload_quads()
{
    FrameMemory& frame = frames_[frame_];
    const VkDeviceSize bytes = quads_.size() * sizeof(shared::Quad);
    if (!frame.quads || frame.used + bytes > frame.quads.size()) {
        const VkDeviceSize size
            = std::max({ smallest_quad_memory, 2 * bytes, frame.quads ? 2 * frame.quads.size() : 0 });
        if (frame.quads)
            frame.retired.push_back(std::move(frame.quads));
        frame.quads = Buffer(gpu_, size, BufferHome::upload, MemoryKind::staging, "2D quads");
        frame.used = 0;
    }
    std::memcpy(frame.quads.mapped() + frame.used, quads_.data(), bytes);
    const VkDeviceAddress address = frame.quads.address() + frame.used;
    frame.used += bytes;
    return address;
}

void Draw2d::record_raw_copies(VkCommandBuffer commands)
{
    for (RawCopy& copy : raw_copies_) {
        const Image& image = raw_pictures_[copy.picture].image;
        record_barrier(commands,
            { image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                VK_ACCESS_TRANSFER_WRITE_BIT });
        VkBufferImageCopy region {};
        region.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
        region.imageExtent = { image.width(), image.height(), 1 };
        vkCmdCopyBufferToImage(
            commands, copy.staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        record_barrier(commands,
            { image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_ACCESS_SHADER_READ_BIT });
        frames_[frame_].retired.push_back(std::move(copy.staging));
    }
    raw_copies_.clear();
}

void Draw2d::record_quads(VkCommandBuffer commands, VkDeviceAddress address) const
{
    VkRenderPassBeginInfo begin { VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO };
    begin.renderPass = render_pass_;
    begin.framebuffer = framebuffer_;
    begin.renderArea.extent = size_;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    bindings_.bind(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, 0);
    const VkViewport viewport { 0, 0, float(size_.width), float(size_.height), 0, 1 };
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &begin.renderArea);
    const shared::QuadPush push { address, { 2 / viewport.width, 2 / viewport.height } };
    vkCmdPushConstants(commands, bindings_.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, sizeof(push), &push);
    vkCmdDraw(commands, uint32_t(quads_.size()) * vertices_per_quad, 1, 0, 0);
    vkCmdEndRenderPass(commands);
}

} // namespace vkpt
