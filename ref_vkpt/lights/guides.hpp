// SPDX-License-Identifier: GPL-2.0-or-later
// Which of the light cache's cells bounce rays aim at (docs/light-cache.md): blocks with some that are far brighter
// than what else a cluster sees.
#pragma once

#include "ref_vkpt/lights/light_cache.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// CacheValue::light, unpacked.
glm::vec3 cached_light(const shared::CacheValue& value);

struct LightCacheGuides {
    std::vector<shared::CacheGuideBlock> blocks; // guide n is blocks[n - 1]
    std::vector<shared::CacheGuideList> lists; // one for each cluster, none for points outside
    std::vector<uint32_t> entries; // guides' numbers
    std::vector<shared::CacheGuide> guides; // what the entries are weighed by
};

struct GuideSources {
    const formats::Bsp& bsp;
    const LightCacheLayout& layout;
    const LightLists& lists;
    std::span<const float> lightstyles;
    std::span<const glm::vec3> colours; // albedo of each texinfo, on average
};

// Also writes the guides' numbers into `values`.
LightCacheGuides choose_guides(const GuideSources& sources, std::span<shared::CacheValue> values);

} // namespace vkpt
