// SPDX-License-Identifier: GPL-2.0-or-later
// From the engine's refdefs, which point to what they do not own, to views, and back.
#pragma once

#include "common/trace/calls.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace vkpt::trace {

// Numbers of models and skins by the engine's handles, and the other way round.
using NumberOf = std::function<uint32_t(const void*)>;
using HandleOf = std::function<void*(uint32_t)>;

View copy_view(const engine::RefDef& refdef, const NumberOf& model, const NumberOf& skin);

std::vector<engine::Entity> entities_of(const View& view, const HandleOf& model, const HandleOf& skin);
// Points into both.
engine::RefDef refdef_of(const View& view, const std::vector<engine::Entity>& entities);

} // namespace vkpt::trace
