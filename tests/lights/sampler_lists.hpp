// SPDX-License-Identifier: GPL-2.0-or-later
// Light lists that samplers are tested with.
#pragma once

#include "sampler_case.hpp"

#include <cstdint>

namespace vkpt::test {

// `count` lights around the point at the origin, about a quarter of them spheres. The list's indices have gaps, so that
// emitters exist that it does not hold. zero_share of all cannot light the point: black, below the horizon, or seen
// from behind.
ListCase make_random_list(size_t count, double zero_share, uint32_t seed);

// As above with every light but one in seven in the list, black ones, lights that cross the horizon, two triangles that
// stand on the surface right beside the point, and translucent ones that rays pass.
ListCase make_hard_list(size_t count, uint32_t seed);

// One bright light in the first place of each stride of eight, near the point: subsets of one shared offset are as
// different as can be.
ListCase make_uneven_list();

// Whether light_probability does not depend on random numbers.
bool has_fixed_probabilities(const Sampler& sampler);

// The values of pt_light_subset that a sampler's tests go through: one where it means nothing.
std::vector<uint32_t> subset_lengths(const Sampler& sampler);

} // namespace vkpt::test
