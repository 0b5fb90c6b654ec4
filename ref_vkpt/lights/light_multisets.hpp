// SPDX-License-Identifier: GPL-2.0-or-later
// Which of a cluster's lights are likely to matter there, as multisets: a light is in its cluster's 1, 2, 4 ... times,
// so that whoever takes entries at equal distances takes lights with probability proportional to how often they are
// there.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/face_triangles.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

struct LightMultisets {
    std::vector<shared::LightMultiset> ranges; // of `entries`, one per list
    std::vector<uint32_t> entries; // the lists' static_indices(), then the multisets'
};

// At map load, for the static lists. At points on the cluster's faces, and in the air, each light has a share s of the
// light that arrives from all, unshadowed. A subset with inclusion probabilities q estimates their sum at a point with
// a second moment of sum s^2 / q, so that q, the root of the mean square of s over the points, makes it least on
// average. A little is added for what a light may have at its nearest place in the cluster, where no point may lie, and
// every light is there at least once.
LightMultisets make_light_multisets(const formats::Bsp& bsp, const FaceTriangles& faces, const LightLists& lists,
    std::span<const shared::Emitter> static_emitters);

} // namespace vkpt
