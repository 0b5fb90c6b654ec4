// SPDX-License-Identifier: GPL-2.0-or-later
#include "sampler_case.hpp"

#include "ref_vkpt/lights/light_trees.hpp"

#include <stdexcept>
#include <string>

namespace vkpt::test {

void ListCase::make_tree()
{
    const LightTrees trees
        = make_light_tree(std::span(static_indices).subspan(range.first_static, range.static_count), emitters);
    tree_nodes = trees.nodes;
    tree_places.assign(range.first_static, 0);
    tree_places.insert(tree_places.end(), trees.places.begin(), trees.places.end());
    tree_lights = uint32_t(static_indices.size()) - range.first_static;
    static_indices.insert(static_indices.end(), trees.lights.begin(), trees.lights.end());
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
