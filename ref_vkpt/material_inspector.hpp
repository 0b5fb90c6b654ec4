// SPDX-License-Identifier: GPL-2.0-or-later
// What the surface under the crosshair is made of, in words: for the command `mat`, and the panel of pt_show_material.
#pragma once

#include "ref_vkpt/overlay/panel.hpp"
#include "ref_vkpt/picked_material.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace vkpt {

struct Module;

// The first line has its name.
std::vector<std::string> describe_material(const Module& module, const PickedMaterial& picked);

class MaterialInspector {
public:
    // Before a frame: looks again, now and then, while pt_show_material is on.
    void update(Module& module);
    // Of the panel, for lines so long; none: it is off.
    std::vector<PanelLine> describe(size_t columns) const;
    void forget_map() { *this = {}; }

private:
    std::vector<std::string> lines_;
    std::chrono::steady_clock::time_point looked_ {};
};

} // namespace vkpt
