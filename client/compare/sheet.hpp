// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "client/compare/measure.hpp"
#include "formats/image.hpp"

namespace vkpt::client {

// Every variant's picture in the order of the table, and the reference at the end, side by side as shown.
formats::Image make_sheet(const SceneResult& scene);

} // namespace vkpt::client
