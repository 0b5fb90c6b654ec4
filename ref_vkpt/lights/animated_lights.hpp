// SPDX-License-Identifier: GPL-2.0-or-later
// Faces whose texture is animated shine as the shown texture says. What a sampler needs of that is a factor to their
// emitters' radiance: a row of the lightstyle table of their own.
#pragma once

#include "ref_vkpt/lights/emitters.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace vkpt {

// Calls `visit` with the texinfos of an animation, starting with `first`, which may be the only one. read_bsp cut
// chains that never come back, and refuses long ones.
template <class Visit> void for_each_frame(const formats::Bsp& bsp, uint32_t first, Visit visit)
{
    uint32_t frame = first;
    while (true) {
        visit(frame);
        const int next = bsp.texinfos[frame].next;
        if (next < 0 || uint32_t(next) == first)
            return;
        frame = uint32_t(next);
    }
}

// Two textures a second, as the classic renderers show them. Any number may be a view's time.
inline int animation_tick(float time) { return time > 0 ? int(std::min(time * 2, 1e9f)) : 0; }

struct AnimatedLight {
    uint32_t lightstyle; // the face's own
    std::vector<float> shares; // by frame, of the radiance that the emitter has
    float share(int tick) const { return shares[size_t(std::max(tick, 0)) % shares.size()]; }
};

class AnimatedLights {
public:
    // Rows from `first_row` on.
    explicit AnimatedLights(uint32_t first_row)
        : first_row_(first_row)
    {
    }
    // Gives the emitters of a face with an animated texture their row.
    void add(const EmissionSource& source, size_t face, std::span<shared::Emitter> emitters);

    bool has(uint32_t row) const { return row >= first_row_ && row - first_row_ < lights_.size(); }
    const AnimatedLight& at(uint32_t row) const { return lights_[row - first_row_]; }
    // Appends the rows to the table, which has those before.
    void append_rows(std::vector<float>& lightstyles, float time) const;

private:
    uint32_t first_row_;
    std::vector<AnimatedLight> lights_;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> rows_; // by texinfo and lightstyle
};

} // namespace vkpt
