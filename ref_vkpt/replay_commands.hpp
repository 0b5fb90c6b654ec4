// SPDX-License-Identifier: GPL-2.0-or-later
// Instant replay: what is kept of the game, the command that shows it in photo mode, and its keys.
#pragma once

#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/overlay/key_filter.hpp"
#include "ref_vkpt/overlay/panel.hpp"

#include <vector>

namespace vkpt {

struct Module;

// A view of the game as it is played.
void keep_for_replay(Module& m, const engine::RefDef& refdef);

// `pt_replay ...`
void run_replay_command(Module& m);
void obey_replay_key(Module& m, PhotoKey key);
// Where it is, and its keys; empty: there is none.
std::vector<PanelLine> describe_replay(const Module& m);

} // namespace vkpt
