// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/pass_statistics.hpp"

#include "common/quantile.hpp"
#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt {

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
        engine::print("ref_vkpt: pass {} median {:.3f} ms, p95 {:.3f} ms", pass.name, find_median(pass.milliseconds),
            find_quantile(pass.milliseconds, 0.95));
}

} // namespace vkpt
