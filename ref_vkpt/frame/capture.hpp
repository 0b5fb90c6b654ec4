// SPDX-License-Identifier: GPL-2.0-or-later
// pt_capture_dir and pt_capture_every: shown frames as PNG files in the engine's writable game folder.
#pragma once

#include "formats/image.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace vkpt {

class FrameCapture {
public:
    // After a frame with a 3D view was submitted. Calls `read_picture`, which waits for the device, only if this frame
    // is to be captured. Frames are counted from the start of the renderer; the first one has the number 1.
    void end_view(const std::function<formats::Image()>& read_picture);

private:
    bool is_wanted();
    void give_up(const std::string& reason);

    uint32_t frame_number_ = 0; // of frames with a 3D view
    // The settings that the last decision was made for, and whether it was to do nothing more with them.
    std::string directory_;
    int every_ = 0;
    bool gave_up_ = false;
};

} // namespace vkpt
