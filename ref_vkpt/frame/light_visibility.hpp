// SPDX-License-Identifier: GPL-2.0-or-later
// What shadow rays have told of the visibility of a map's lights: the table on the device, and when light samplers get
// to know. See shaders/shared/light_visibility.h.
#pragma once

#include "ref_vkpt/vulkan/uploader.hpp"
#include "shaders/shared/frame.h"

#include <cstdint>
#include <string_view>

namespace vkpt {

struct GpuWorld;

// Every light is believed to be in sight.
Buffer make_light_visibility(Uploader& uploader);

class LightVisibilityKeeper {
public:
    // Tells the shaders whether this view uses the table, and which of its rays count. `static_emitters`: of the map.
    void begin_frame(shared::FrameUniforms& uniforms, const GpuWorld& gpu_world, std::string_view light_sampler,
        uint32_t static_emitters);
    // Another number wherever the last view's choices of lights went by other weights: repeated samples would differ.
    uint32_t state() const { return is_used_ ? publications_ : 0; }

private:
    uint64_t world_ = 0; // GpuWorld::version of the map that the table is of
    bool is_used_ = false, publishes_ = false;
    uint32_t frames_ = 0, interval_ = 1; // since the last publication, and to the next
    uint32_t made_ = 0; // publications of this map's table
    uint32_t publications_ = 1; // of any
};

} // namespace vkpt
