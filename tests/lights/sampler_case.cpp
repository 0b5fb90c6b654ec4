// SPDX-License-Identifier: GPL-2.0-or-later
#include "sampler_case.hpp"

namespace vkpt::test {

float draw_unit(std::mt19937& rng) { return float(rng() >> 8) * 0x1p-24f; }

Draw make_draw(std::mt19937& rng)
{
    Draw draw;
    draw.light = draw_unit(rng);
    draw.point = { draw_unit(rng), draw_unit(rng) };
    draw.stream = uint32_t(rng());
    return draw;
}

std::vector<Sampler>& all_samplers()
{
    static std::vector<Sampler> samplers;
    return samplers;
}

bool register_sampler(const Sampler& sampler)
{
    all_samplers().push_back(sampler);
    return true;
}

} // namespace vkpt::test
