// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/replay/replay_ring.hpp"

#include "common/trace/view_copy.hpp"

#include <algorithm>

namespace vkpt {

using trace::Call;
using trace::CallKind;

namespace {

constexpr int compression_level = 1; // between frames
constexpr float min_step = 0.012f; // seconds between views
constexpr uint32_t calls_per_view = 3; // begin_frame, render_view, end_frame

} // namespace

void ReplayRing::begin_map(std::string_view map)
{
    *this = {};
    map_ = map;
    note(CallKind::begin_registration, map, nullptr);
}

void ReplayRing::note(CallKind kind, std::string_view name, const void* handle)
{
    Call& call = registration_.emplace_back(make_call(kind, name));
    if (!handle)
        return;
    const auto [known, is_new] = numbers_.try_emplace(handle, uint32_t(handles_.size()));
    if (is_new)
        handles_.push_back(const_cast<void*>(handle));
    call.numbers[0] = int32_t(known->second);
}

void ReplayRing::note_model(std::string_view name, const void* handle)
{
    if (handle && !map_.empty() && !numbers_.contains(handle))
        note(CallKind::register_model, name, handle);
}

void ReplayRing::note_skin(std::string_view name, const void* handle)
{
    if (handle && !map_.empty() && !numbers_.contains(handle))
        note(CallKind::register_skin, name, handle);
}

void ReplayRing::note_sky(std::string_view name, float rotate, const float axis[3])
{
    if (map_.empty())
        return;
    note(CallKind::set_sky, name, nullptr);
    registration_.back().reals = { rotate, axis[0], axis[1], axis[2] };
}

void ReplayRing::end_registration()
{
    if (!map_.empty())
        note(CallKind::end_registration, "", nullptr);
}

uint32_t ReplayRing::number_of(const void* handle) const
{
    const auto known = numbers_.find(handle);
    return known != numbers_.end() ? known->second : 0;
}

void ReplayRing::forget_views()
{
    writer_ = {};
    chunks_.clear();
    bytes_ = 0;
}

void ReplayRing::add(const engine::RefDef& refdef, const Limits& limits)
{
    if (limits.seconds <= 0)
        return forget_views();
    if (map_.empty() || !(refdef.time >= 0))
        return;
    if (!chunks_.empty() && refdef.time < chunks_.back().end) // the clock started anew
        forget_views();
    if (!chunks_.empty() && refdef.time < chunks_.back().end + min_step)
        return;
    if (chunks_.empty() || !chunks_.back().packed.empty())
        chunks_.push_back({ {}, refdef.time, refdef.time, 0 });
    Call begin = make_call(CallKind::begin_frame), end = make_call(CallKind::end_frame);
    const auto number = [this](const void* handle) { return number_of(handle); };
    trace::View view = trace::copy_view(refdef, number, number);
    writer_.write(begin);
    writer_.write(view);
    writer_.write(end);
    Chunk& chunk = chunks_.back();
    chunk.end = refdef.time;
    chunk.views++;
    if (writer_.is_full()) {
        chunk.packed = writer_.take(compression_level);
        bytes_ += chunk.packed.size();
        keep_limits(limits);
    }
}

void ReplayRing::keep_limits(const Limits& limits)
{
    while (chunks_.size() > 1 && (bytes_ > limits.bytes || chunks_.front().end < chunks_.back().end - limits.seconds)) {
        bytes_ -= chunks_.front().packed.size();
        chunks_.pop_front();
    }
}

float ReplayRing::seconds() const { return chunks_.empty() ? 0 : chunks_.back().end - chunks_.front().start; }

size_t ReplayRing::views() const
{
    size_t count = 0;
    for (const Chunk& chunk : chunks_)
        count += chunk.views;
    return count;
}

std::vector<std::byte> ReplayRing::make_trace(std::span<const Call> head)
{
    if (!chunks_.empty() && chunks_.back().packed.empty()) {
        chunks_.back().packed = writer_.take(compression_level);
        bytes_ += chunks_.back().packed.size();
    }
    std::vector<std::byte> file = trace::make_header();
    const auto append
        = [&](const std::vector<std::byte>& bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); };
    trace::ChunkWriter first;
    trace::TraceTotals totals;
    for (const std::span<const Call> calls : { head, std::span<const Call>(registration_) })
        for (Call call : calls) {
            first.write(call);
            totals.count(call.kind);
        }
    append(first.take(compression_level));
    for (const Chunk& chunk : chunks_) {
        append(chunk.packed);
        totals.calls += calls_per_view * chunk.views;
        totals.frames += chunk.views;
        totals.views += chunk.views;
    }
    append(trace::pack_chunk(trace::tag_end, std::as_bytes(std::span(&totals, 1)), 0, compression_level));
    return file;
}

} // namespace vkpt
