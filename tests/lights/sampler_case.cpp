// SPDX-License-Identifier: GPL-2.0-or-later
#include "sampler_case.hpp"

#include <stdexcept>
#include <string>

namespace vkpt::test {

void ListCase::make_tables(const shared::LightMultiset& multiset)
{
    tables = make_sampler_tables({ std::span(&range, 1), static_indices, emitters }, shared::SAMPLER_NEEDS);
    tables.multisets = { multiset };
    static_indices = tables.indices;
}

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

const Sampler& find_sampler(std::string_view name)
{
    for (const Sampler& sampler : all_samplers())
        if (sampler.name == name)
            return sampler;
    throw std::out_of_range("no light sampler " + std::string(name));
}

bool register_sampler(const Sampler& sampler)
{
    all_samplers().push_back(sampler);
    return true;
}

} // namespace vkpt::test
