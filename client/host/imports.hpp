// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ref_vkpt/engine/contract.hpp"

namespace vkpt::client {

class FileSystem;
class Host;

// The engine's functions on behalf of the one host.
struct HostImports {
    static void bind(Host* host); // nullptr: unbind
    static engine::Imports table();
    // From now on the host reads from these; nullptr: there are none.
    static void use_files(Host& host, FileSystem* files);
    // From the next frame on pictures have this size. As in an engine that starts its renderer once more and keeps the
    // context: devices and pipelines stay.
    static void resize(Host& host, int width, int height);

private:
    static void add_commands(engine::Imports& imports);
    static void add_files(engine::Imports& imports);
    static void add_video(engine::Imports& imports);
};

} // namespace vkpt::client
