// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/replay/replay.hpp"

#include "common/trace/blend_views.hpp"
#include "common/trace/view_copy.hpp"

#include <algorithm>
#include <string>

namespace vkpt {

Replay::Replay(std::span<const std::byte> trace, std::vector<void*> handles)
    : reader_({ reinterpret_cast<const char*>(trace.data()), trace.size() }, "the replay")
    , handles_(std::move(handles))
    , length_(reader_.frame_count() > 0 ? reader_.seconds(reader_.frame_count() - 1) : 0)
{
}

void Replay::seek(double place) { place_ = std::clamp(place, 0.0, length_); }

void Replay::step(int views)
{
    pause();
    const int last = int(reader_.frame_count()) - 1, now = int(reader_.frame_at(place_));
    // Back from between two views to the first of them.
    const bool is_between = views < 0 && place_ > reader_.seconds(size_t(now));
    seek(reader_.seconds(size_t(std::clamp(now + views + is_between, 0, last))));
}

void Replay::play(double speed)
{
    speed_ = speed;
    is_playing_ = speed != 0;
    if (speed > 0 && place_ >= length_)
        place_ = 0;
    else if (speed < 0 && place_ <= 0)
        place_ = length_;
}

void Replay::advance(double seconds)
{
    if (!is_playing_)
        return;
    const double wanted = place_ + seconds * speed_;
    seek(wanted);
    is_playing_ = wanted > 0 && wanted < length_;
}

bool Replay::takes_moment()
{
    const bool is_new = shown_ != place_;
    shown_ = place_;
    return is_new;
}

const engine::RefDef& Replay::moment()
{
    const size_t frame = reader_.frame_at(place_), next = std::min(frame + 1, reader_.frame_count() - 1);
    if (frame != frame_) {
        before_ = reader_.frame(frame).views.front();
        after_ = reader_.frame(next).views.front();
        frame_ = frame;
    }
    const double start = reader_.seconds(frame), length = reader_.seconds(next) - start;
    const float share = length > 0 ? float((place_ - start) / length) : 0.0f;
    view_ = trace::blend_views(before_, after_, share);
    const auto handle = [this](uint32_t number) { return number < handles_.size() ? handles_[number] : nullptr; };
    entities_ = trace::entities_of(view_, handle, handle);
    refdef_ = trace::refdef_of(view_, entities_);
    return refdef_;
}

} // namespace vkpt
