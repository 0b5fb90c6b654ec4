// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/capture.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"

namespace vkpt {

bool FrameCapture::is_wanted()
{
    const int every = cvars::values().pt_capture_every;
    if (every != every_) {
        report();
        every_ = every;
        gave_up_ = false;
    }
    return every != 0 && !gave_up_ && (frame_number_ - 1) % uint32_t(every) == 0;
}

void FrameCapture::open_folder()
{
    const std::string& name = cvars::values().pt_capture_dir;
    if (name.empty())
        throw FileError("pt_capture_dir is empty; set it at the start: +set pt_capture_dir NAME");
    if (!is_plain_name(name))
        throw FileError(fmt::format("pt_capture_dir \"{}\" may have only letters, digits, _ and -", name));
    const OutputFolder captures(engine::game_directory(), { "vkpt", "captures" });
    room_ = { "captures", captures.path(), captures.bytes(), uint64_t(cvars::values().pt_capture_mib) * mebibyte };
    folder_.emplace(captures.make_new(name));
}

void FrameCapture::report()
{
    if (captured_frames_ != 0)
        engine::print("ref_vkpt: {} captured frames are in {}", captured_frames_, folder_->path().string());
    captured_frames_ = 0;
}

void FrameCapture::end_view(const std::function<formats::Image()>& read_image)
{
    frame_number_++;
    if (!is_wanted())
        return;
    try {
        if (!folder_)
            open_folder();
        const std::vector<std::byte> image = formats::write_png(read_image());
        folder_->check_room(image.size(), room_);
        room_.used += image.size();
        folder_->write(fmt::format("frame{:06}.png", frame_number_), image);
        captured_frames_++;
    } catch (const FileError& error) {
        report();
        engine::print("ref_vkpt: no frames are captured: {}", error.what());
        gave_up_ = true;
    }
}

} // namespace vkpt
