// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/pass_statistics.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt {

float find_quantile(std::vector<float> values, double fraction)
{
    const size_t rank = size_t(std::ceil(fraction * double(values.size()))) - 1;
    std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(rank));
    return values[rank];
}

CpuTimer::~CpuTimer()
{
    innermost_ = outer_;
    const Clock::duration whole = Clock::now() - start_;
    if (outer_)
        outer_->inside_ += whole;
    if (statistics_)
        statistics_->add(name_, std::chrono::duration<double, std::milli>(whole - inside_).count());
}

void PassStatistics::add(std::string_view name, double milliseconds)
{
    auto pass = std::ranges::find(passes_, name, &Pass::name);
    if (pass == passes_.end())
        pass = passes_.insert(passes_.end(), { std::string(name), {} });
    pass->milliseconds.push_back(float(milliseconds));
}

void PassStatistics::print() const
{
    for (const Pass& pass : passes_)
        engine::print("ref_vkpt: pass {} median {:.3f} ms, p95 {:.3f} ms", pass.name,
            find_quantile(pass.milliseconds, 0.5), find_quantile(pass.milliseconds, 0.95));
}

} // namespace vkpt
