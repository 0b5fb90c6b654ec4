// SPDX-License-Identifier: GPL-2.0-or-later
// The packed lights of emitters: what lights are weighed by, their lightstyles applied. A frame costs what has changed:
// the moving emitters, and those of the map whose lightstyle flickers.
#pragma once

#include "shaders/shared/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// `lightstyle`: its scale.
shared::PackedLight pack_light_shape(const shared::Emitter& emitter, float lightstyle);

// Of one map: which of its emitters have which lightstyle.
class PackedLightWriter {
public:
    PackedLightWriter() = default;
    explicit PackedLightWriter(std::span<const shared::Emitter> emitters);

    // `target` holds the packed lights for the scales `held` (empty: nothing yet), one scale for each lightstyle;
    // afterwards both are as `scales` says. `emitters` are those of the constructor. Returns how many were written.
    size_t update(shared::PackedLight* target, std::vector<float>& held, std::span<const shared::Emitter> emitters,
        std::span<const float> scales) const;

private:
    std::vector<std::vector<uint32_t>> emitters_of_style_;
};

// Those of all `emitters`, dark behind them up to `count`.
void write_packed_lights(shared::PackedLight* target, size_t count, std::span<const shared::Emitter> emitters,
    std::span<const float> scales);

} // namespace vkpt
