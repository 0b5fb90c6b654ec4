// SPDX-License-Identifier: GPL-2.0-or-later
// Where a command's frames come from: SCENE on the command line, a map or a trace. A frame is drawn through a host, as
// often and in any order as wanted; so a command need not know which of both it works on.
#pragma once

#include "client/host/client_map.hpp"
#include "client/host/host.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::client {

class FrameSource {
public:
    FrameSource() = default;
    virtual ~FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;

    // Registers with the module what the first frame needs. Once for every host, before its first draw.
    virtual void register_with(Host& host) = 0;
    // One whole frame in the host's size. With pt_accumulate 1 the same frame again goes on averaging, another one
    // starts anew. Frames in order, each once, are what the engine would show: filters and exposure look back.
    void draw(Host& host, int frame);

    // Nothing: endless.
    virtual std::optional<int> frame_count() const = 0;
    // The frame that the command line names (FILE.rtrace@frame), else 0.
    virtual int chosen_frame() const = 0;
    // Since the first frame.
    virtual double seconds(int frame) const = 0;

    // Where a frame is seen from. Another camera than its own stays for all frames until nothing is set.
    virtual Camera camera(int frame) const = 0;
    virtual void set_camera(const std::optional<Camera>& camera) = 0;
    // Things that were left out or replaced, one line each; complete after register_with.
    virtual std::vector<std::string> notes() const = 0;

private:
    virtual void draw_frame(Host& host, int frame) = 0;

    int last_frame_ = 0;
};

// SCENE = maps/NAME.bsp[@x,y,z[,pitch,yaw]] or FILE.rtrace[@frame]. `files` must outlive the source. Throws WrongUse,
// Failure, FormatError.
std::unique_ptr<FrameSource> open_frame_source(FileSystem& files, std::string_view scene);

} // namespace vkpt::client
