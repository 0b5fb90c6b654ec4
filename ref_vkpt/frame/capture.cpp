// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/capture.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/frame/game_file.hpp"

#include <filesystem>

namespace vkpt {

void FrameCapture::give_up(const std::string& reason)
{
    engine::print("ref_vkpt: no frames are captured: {}", reason);
    gave_up_ = true;
}

bool FrameCapture::is_wanted()
{
    const CvarValues& cvars = cvars::values();
    if (cvars.pt_capture_every == 0) {
        every_ = 0;
        return false;
    }
    if (cvars.pt_capture_every != every_ || cvars.pt_capture_dir != directory_) {
        every_ = cvars.pt_capture_every;
        directory_ = cvars.pt_capture_dir;
        gave_up_ = false;
        if (directory_.empty())
            give_up("pt_capture_dir does not say where to");
        else if (!stays_in_game_directory(directory_))
            give_up(fmt::format(
                "pt_capture_dir \"{}\" must be a folder below the game's, without \"..\" and backslashes", directory_));
    }
    return !gave_up_ && (frame_number_ - 1) % uint32_t(every_) == 0;
}

void FrameCapture::end_view(const std::function<formats::Image()>& read_picture)
{
    frame_number_++;
    if (!is_wanted())
        return;
    const std::filesystem::path path
        = std::filesystem::path(engine::game_directory()) / directory_ / fmt::format("frame{:06}.png", frame_number_);
    const std::string reason = write_game_file(path, formats::write_png(read_picture()));
    if (!reason.empty())
        give_up(fmt::format("{}: {}", path.string(), reason));
}

} // namespace vkpt
