// SPDX-License-Identifier: GPL-2.0-or-later
// Photo mode in the course of frames, and its command.
#pragma once

#include "formats/image.hpp"

#include <functional>

namespace vkpt {

struct Module;

// `pt_photo ...`
void run_photo_command(Module& m);
// In a map that has been drawn, between frames.
void enter_photo_mode(Module& m, bool by_pause = false);
// With its replay.
void leave_photo_mode(Module& m);

// Between frames: keys, the mouse, the focus.
void begin_photo_frame(Module& m);
// The frame was submitted. Takes the photograph that is wished for; `read_image` waits for the device.
void end_photo_frame(Module& m, const std::function<formats::Image()>& read_image);

} // namespace vkpt
