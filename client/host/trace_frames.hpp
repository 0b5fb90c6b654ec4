// SPDX-License-Identifier: GPL-2.0-or-later
// The frames of a trace: the module is asked what the engine asked the recording module.
#pragma once

#include "client/host/frame_source.hpp"
#include "client/host/view_placement.hpp"
#include "common/trace/trace_reader.hpp"

#include <cstdint>

namespace vkpt::client {

class TraceFrames final : public FrameSource {
public:
    TraceFrames(FileSystem& files, std::string_view path, int chosen_frame);

    void register_with(Host& host) override;
    std::optional<int> frame_count() const override { return int(reader_.frame_count()); }
    int chosen_frame() const override { return chosen_frame_; }
    double seconds(int frame) const override;
    Camera camera(int frame) const override;
    void set_camera(const std::optional<Camera>& camera) override { camera_ = camera; }
    std::vector<std::string> notes() const override { return notes_; }

    // The view `seconds` after the first frame, between two that were recorded, without 2D. Films: with pt_accumulate 1
    // it goes into the average of the last one if `blends`; else the average starts anew.
    void draw_moment(Host& host, double seconds, bool blends);

private:
    // Two recorded views, one after the other.
    struct Pair {
        size_t frame = size_t(-1); // of the first
        trace::View before, after;
        bool is_cut = false;
        size_t lasting = 0; // calls that both need
    };
    const Pair& find_pair(size_t frame);
    // The module's, by the trace's numbers. As in the engine, a registration ends the life of those from before that it
    // does not name again.
    class Handles {
    public:
        void keep(int32_t number, void* handle);
        void* find(uint32_t number) const; // nullptr: none

    private:
        std::vector<void*> handles_;
    };

    void draw_frame(Host& host, int frame) override;
    void check_files(FileSystem& files);
    void prepare(Host& host, size_t lasting_count);
    void apply(Host& host, const trace::Call& call);
    void set(Host& host, const trace::Call& setting);
    void draw_view(Host& host, const trace::View& view);
    void draw_2d(const engine::Exports8& module, const trace::Call& call) const;
    size_t lasting_before(size_t frame) const;
    size_t registration_of(size_t lasting_count) const;

    std::string path_;
    mutable trace::TraceReader reader_; // it keeps what it decoded last
    int chosen_frame_;
    std::vector<std::string> notes_;
    std::optional<Camera> camera_;
    ViewPlacement placement_ { 1, 1, 1, 1 };
    size_t applied_ = 0; // of the trace's lasting calls
    Handles models_, skins_;
    Pair pair_;
};

} // namespace vkpt::client
