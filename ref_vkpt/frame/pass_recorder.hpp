// SPDX-License-Identifier: GPL-2.0-or-later
// Records passes by their rows (pass_rows.hpp): shader, debug label, timer, and a barrier before each pass that reads
// what one before it wrote, or writes what one before it used. Passes that share nothing may overlap: a single
// workgroup's does not keep the device from the next.
#pragma once

#include "ref_vkpt/frame/graphics.hpp"
#include "ref_vkpt/frame/pass_shaders.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace vkpt {

// How much a pass has to do: pixels, or whatever is arranged like them. They are as many launch indices where it is a
// ray generation shader.
struct PassWork {
    glm::uvec2 size { 0 };
    uint32_t groups = 0; // workgroups; 0: as many as it takes
};

// One run of a pass: what it is told, and how much it has to do.
struct PassStep {
    PassWork work;
    uint32_t push_bytes = 0;
    std::array<std::byte, push_constant_bytes> push {};
};
template <class Push> PassStep make_step(const Push& push, const PassWork& work)
{
    PassStep step { work, sizeof(Push), {} };
    static_assert(sizeof(Push) <= push_constant_bytes);
    std::memcpy(step.push.data(), &push, sizeof(Push));
    return step;
}

// The runs of a frame's pass in one view.
std::vector<PassStep> pass_steps(const Pass& pass, const shared::FrameUniforms& uniforms);

class PassRecorder {
public:
    explicit PassRecorder(Graphics& graphics)
        : graphics_(graphics)
    {
    }

    // The commands that follow. Whatever ran before is visible to them.
    void begin(VkCommandBuffer commands, const ShaderChoice& choice);
    // `step.push` has the size that the pass's row says.
    void record(const Pass& pass, const PassStep& step);

private:
    void wait_for_what_it_uses(const Pass& pass);
    void dispatch(const Pass& pass, const PassWork& work);

    Graphics& graphics_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    ShaderChoice choice_;
    PassResources read_ = 0, written_ = 0; // since the last barrier
};

} // namespace vkpt
