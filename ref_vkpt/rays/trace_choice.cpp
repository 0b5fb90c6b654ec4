// SPDX-License-Identifier: GPL-2.0-or-later
// The file has a line per device and driver: key, fastest backend and figures, between tabs.
#include "ref_vkpt/rays/trace_choice.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/rays/trace_ranking.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace vkpt {

namespace {

constexpr const char* wanted_auto = "auto";

bool starts_with_key(const std::string& line, const std::string& key)
{
    return line.size() > key.size() && line.compare(0, key.size(), key) == 0 && line[key.size()] == '\t';
}

} // namespace

TraceChoice::TraceChoice(const Device& device, std::string file)
    : device_(device)
    , file_(std::move(file))
    , device_key_(
          fmt::format("{} / {} / {:x}", device.properties.deviceName, device.driver, device.properties.driverVersion))
    , offered_(offered_backends(device))
{
    std::ranges::replace(device_key_, '\t', ' ');
    std::ranges::replace(device_key_, '\n', ' ');
}

TraceBackend TraceChoice::choose(const std::string& wanted)
{
    if (current_ && wanted == last_wanted_)
        return *current_;
    last_wanted_ = wanted;
    wants_measurement_ = false;
    if (wanted == wanted_auto)
        current_ = choose_automatically();
    else
        current_ = fall_back(wanted);
    return *current_;
}

// The named backend, or what "auto" gives where the device lacks it.
TraceBackend TraceChoice::fall_back(const std::string& wanted)
{
    const std::optional<TraceBackend> named = find_trace_backend(wanted);
    if (named && std::ranges::find(offered_, *named) != offered_.end()) {
        say(*named, "as pt_trace says");
        return *named;
    }
    std::string known;
    for (const TraceBackend backend : offered_)
        known += fmt::format("{}{}", known.empty() ? "" : ", ", name_of(backend));
    engine::print("ref_vkpt: {} does not support pt_trace \"{}\" (it offers {}): using auto",
        device_.properties.deviceName, wanted, known);
    return choose_automatically();
}

TraceBackend TraceChoice::choose_automatically()
{
    if (offered_.size() == 1) {
        say(TraceBackend::software, "the device offers nothing else");
        return TraceBackend::software;
    }
    if (const auto measured = recall()) {
        say(measured->fastest, fmt::format("measured on this device: {}", measured->figures));
        return measured->fastest;
    }
    if (!device_.traits.measures_traces) {
        say(TraceBackend::software, "the fastest on CPU drivers; use pt_trace_measure to check");
        return TraceBackend::software;
    }
    wants_measurement_ = true;
    return offered_[1]; // until it is measured
}

void TraceChoice::measure(const Measure& measure)
{
    wants_measurement_ = false;
    std::vector<std::vector<double>> times(offered_.size());
    for (int turn = 0; turn < device_.traits.trace_measurements; turn++)
        for (size_t i = 0; i < offered_.size(); i++)
            times[i].push_back(measure(offered_[i]));
    const std::optional<TraceRanking> ranking = rank_traces(times);
    if (!ranking) {
        engine::print("ref_vkpt: {} measures no times: rays go on by {}", device_.properties.deviceName,
            name_of(current_.value_or(TraceBackend::software)));
        return;
    }
    Measured measured;
    measured.fastest = offered_[ranking->fastest];
    for (size_t i = 0; i < offered_.size(); i++)
        measured.figures += fmt::format("{}{} {:.3g} ns", i > 0 ? ", " : "", name_of(offered_[i]), ranking->medians[i]);
    measured.figures += " a ray";
    if (ranking->is_clear)
        remember(measured);
    else
        measured.figures += "; too close to be remembered";
    if (last_wanted_ != wanted_auto) {
        engine::print("ref_vkpt: fastest on this device: {} ({}); pt_trace auto uses it", name_of(measured.fastest),
            measured.figures);
        return;
    }
    say(measured.fastest, fmt::format("measured now: {}", measured.figures));
    current_ = measured.fastest;
}

std::optional<TraceChoice::Measured> TraceChoice::recall() const
{
    std::ifstream file(file_);
    for (std::string line; std::getline(file, line);) {
        if (!starts_with_key(line, device_key_))
            continue;
        const size_t start = device_key_.size() + 1, tab = line.find('\t', start);
        const auto backend = find_trace_backend(line.substr(start, tab - start));
        if (tab != std::string::npos && backend && std::ranges::find(offered_, *backend) != offered_.end())
            return Measured { *backend, line.substr(tab + 1) };
    }
    return std::nullopt;
}

void TraceChoice::remember(const Measured& measured) const
{
    if (file_.empty())
        return;
    std::vector<std::string> lines;
    std::ifstream old(file_);
    for (std::string line; std::getline(old, line);)
        if (!starts_with_key(line, device_key_))
            lines.push_back(line);
    lines.push_back(fmt::format("{}\t{}\t{}", device_key_, name_of(measured.fastest), measured.figures));
    // Written beside and renamed, so that a cut write leaves the old file. One that cannot be written is no error: the
    // measurement is made again next time.
    const std::string partial = fmt::format("{}.{}.new", file_, getpid());
    std::ofstream file(partial);
    for (const std::string& line : lines)
        file << line << '\n';
    file.close();
    std::error_code ignored;
    if (file)
        std::filesystem::rename(partial, file_, ignored);
    else
        std::filesystem::remove(partial, ignored);
}

void TraceChoice::say(TraceBackend backend, const std::string& why)
{
    engine::print("ref_vkpt: rays by {}: {}", name_of(backend), why);
}

} // namespace vkpt
