// SPDX-License-Identifier: GPL-2.0-or-later
// Which lights reach the place under the crosshair, and what the light sampler makes of them; the command `pt_lights`,
// and the panel of pt_show_lights.
#pragma once

#include "ref_vkpt/overlay/panel.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vkpt {

struct Module;

// A light of the list there: a lamp with all its triangles, or one emitter.
struct LightRow {
    std::optional<uint32_t> light; // of MapLights; none: it moves, or belongs to something that does
    std::string name;
    float distance = 0; // units
    double chosen = 0; // how often the sampler chooses it
    double share = 0; // of the light that would arrive if nothing cast shadows, as the sampler predicts it
};

class LightInspector {
public:
    // `pt_lights`, `pt_lights mute N`, `pt_lights solo N`, `pt_lights all`.
    void run(Module& module);
    // Before a frame: looks again, now and then, while pt_show_lights is on.
    void update(Module& module);
    // Of the panel; none: it is off.
    std::vector<PanelLine> describe() const;
    void forget_map() { *this = {}; }

private:
    void look(Module& module);
    void print() const;
    void change(Module& module, bool solo);

    std::vector<LightRow> rows_; // the likeliest first
    std::string place_; // what is said of all of them, or why there are none
    std::chrono::steady_clock::time_point looked_ {};
};

} // namespace vkpt
