// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/pass_statistics.hpp"

#include <algorithm>

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
    std::vector<float>& samples = pass->milliseconds;
    if (samples.size() == 2 * kept)
        samples.erase(samples.begin(), samples.begin() + kept);
    samples.push_back(float(milliseconds));
}

} // namespace vkpt
