// SPDX-License-Identifier: GPL-2.0-or-later
#include "sampler_case.hpp"

namespace vkpt::test {

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
