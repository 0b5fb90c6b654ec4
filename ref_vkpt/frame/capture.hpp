// SPDX-License-Identifier: GPL-2.0-or-later
// pt_capture_dir and pt_capture_every: shown frames as PNG files in vkpt/captures/ of the engine's writable game
// folder.
#pragma once

#include "formats/image.hpp"
#include "ref_vkpt/files/output_folder.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace vkpt {

class FrameCapture {
public:
    ~FrameCapture() { report(); }

    // After a frame with a 3D view was submitted. Calls `read_image`, which waits for the device, only if this frame
    // is to be captured. Frames are counted from the start of the renderer; the first one has the number 1.
    void end_view(const std::function<formats::Image()>& read_image);

private:
    bool is_wanted();
    void open_folder();
    // Says how many frames there are and where. Only when no more follow: console lines are part of the image.
    void report();

    uint32_t frame_number_ = 0; // of frames with a 3D view
    int every_ = 0; // that the last decision was made for
    bool gave_up_ = false; // until pt_capture_every changes
    std::optional<OutputFolder> folder_; // a new one at each start of the renderer
    uint32_t captured_frames_ = 0; // that the console has not been told of
    FileRoom room_; // of all captures there are, this folder's and older ones
};

} // namespace vkpt
