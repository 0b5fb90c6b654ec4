// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/sampler_tables.hpp"

namespace vkpt {

SamplerTables make_sampler_tables(const SamplerTableSource& source, uint32_t needs)
{
    SamplerTables tables;
    tables.needs = needs & shared::SAMPLER_NEEDS;
    tables.indices.assign(source.static_indices.begin(), source.static_indices.end());
#define VKPT_SAMPLER_NEED(trait, bit, make)                                                                            \
    if (needs & shared::trait)                                                                                         \
        make(source, tables);
#include "shaders/shared/sampler_tables.def"
    return tables;
}

} // namespace vkpt
