// SPDX-License-Identifier: GPL-2.0-or-later
// A demo as a trace, for who wants more of it than its file.
#pragma once

#include "client/host/file_system.hpp"
#include "client/record/engine_run.hpp"

#include <memory>
#include <string>
#include <vector>

namespace vkpt::client {

struct RecordOptions {
    std::string demo, output, engine, base_folder, game, size = "1280x720", sound;
    int rate = 60;
    bool timedemo = false, with_sound = false;
    std::vector<std::string> settings;
};

// Plays the demo in the engine. The trace lives as long as the result. Throws Failure, WrongUse.
std::unique_ptr<EngineRun> record_demo(const RecordOptions& options, const FileSystem& files);

} // namespace vkpt::client
