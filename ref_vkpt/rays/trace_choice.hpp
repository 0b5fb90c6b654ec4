// SPDX-License-Identifier: GPL-2.0-or-later
// Which trace backend runs: what pt_trace says, and for "auto" what this device was measured to do fastest. The
// measurement is made once per device and driver version and kept in a small text file in the module's cache.
#pragma once

#include "ref_vkpt/rays/backend.hpp"

#include <functional>
#include <string>

namespace vkpt {

class TraceChoice {
public:
    // `file`: empty: nothing is remembered. The device outlives this.
    TraceChoice(const Device& device, std::string file);

    // The backend for this value of pt_trace. Says in one console line what was chosen and why, when it changes.
    TraceBackend choose(const std::string& wanted);
    // "auto" has not been decided yet: the next chance to measure should be taken.
    bool wants_measurement() const { return wants_measurement_; }

    // Nanoseconds per ray by a backend, on this device now. Asked several times on GPUs.
    using Measure = std::function<double(TraceBackend)>;
    // Measures what the device offers, says the result, and remembers it if it is clear (trace_ranking.hpp).
    void measure(const Measure& measure);

private:
    struct Measured {
        TraceBackend fastest = TraceBackend::software;
        std::string figures; // "query 1.2 ns, software 5.0 ns a ray"
    };
    TraceBackend choose_automatically();
    TraceBackend fall_back(const std::string& wanted);
    std::optional<Measured> recall() const;
    void remember(const Measured& measured) const;
    void say(TraceBackend backend, const std::string& why);

    const Device& device_;
    std::string file_;
    std::string device_key_; // this device and driver, as in the file
    std::vector<TraceBackend> offered_;
    std::string last_wanted_;
    std::optional<TraceBackend> current_;
    bool wants_measurement_ = false;
};

} // namespace vkpt
