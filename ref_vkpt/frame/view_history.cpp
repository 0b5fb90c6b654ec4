// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/view_history.hpp"

#include <glm/geometric.hpp>

namespace vkpt {

namespace {

// A player who runs, falls or is thrown stays below this between two views (Quake units); beyond it is a teleport or a
// cut.
constexpr float max_eye_movement = 128;
// Seconds. Time that goes back is another demo, or another life.
constexpr float longest_pause = 1;

} // namespace

bool ViewHistory::continues_into(const Key& now) const
{
    const float passed = now.time - last_.time;
    // Without upscaling, anti-aliasing has no image of another size to go on with.
    const bool same_pixels = now.resolved_size == last_.resolved_size;
    return valid_ && (same_pixels || !now.antialiases) && now.output_size == last_.output_size
        && now.world == last_.world && now.denoiser == last_.denoiser && now.antialiases == last_.antialiases
        && passed >= 0 && passed < longest_pause && glm::distance(now.camera.eye, last_.camera.eye) < max_eye_movement;
}

void ViewHistory::keep(const Key& now)
{
    last_ = now;
    valid_ = true;
}

} // namespace vkpt
