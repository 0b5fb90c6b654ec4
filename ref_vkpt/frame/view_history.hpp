// SPDX-License-Identifier: GPL-2.0-or-later
// What the denoiser has to know of the last view, and whether its pixels still say anything about this one.
#pragma once

#include "ref_vkpt/scene/snapshot.hpp"

#include <cstdint>

namespace vkpt {

class ViewHistory {
public:
    struct Key {
        shared::Camera camera {};
        glm::uvec2 size { 0 }; // rendered pixels; may differ
        glm::uvec2 output_size { 0 }; // of the view in the window
        glm::uvec2 resolved_size { 0 }; // after anti-aliasing
        uint64_t world = 0; // GpuWorld::version
        float time = 0; // seconds of the game
        int denoiser = 0; // of the shaders' cvars
        bool antialiases = false;
        glm::vec2 pixel_offset { 0.5f }; // of the camera's rays; may differ
    };

    // The last view's pixels were lost.
    void forget() { valid_ = false; }
    // True: the last view continues into this one: same map, same place in the window, no cut, no leap in time.
    bool continues_into(const Key& now) const;
    // `now` has been recorded, and is the last view from here on.
    void keep(const Key& now);
    const Key& last() const { return last_; }

private:
    Key last_;
    bool valid_ = false;
};

} // namespace vkpt
