// SPDX-License-Identifier: GPL-2.0-or-later
// One scene on the module, ready to be drawn by any variant.
#pragma once

#include "client/analysis/linear_image.hpp"
#include "client/compare/variant.hpp"
#include "client/host/frame_source.hpp"
#include "client/options.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vkpt::client {

struct StageOptions {
    ModuleOptions module;
    std::string base_folder, game;
    Size size;
};

// Milliseconds of one frame on the device.
struct FrameTime {
    double all = 0; // every pass
    double light = 0; // direct_light and indirect_light
};

class Stage {
public:
    // Loads the module and registers the scene. Throws as Host and open_frame_source do.
    Stage(const StageOptions& options, const std::string& scene);

    const ModuleInfo& info() const { return info_; }
    // The frame that is compared; filters may look back at `frames_before()` others.
    int frame() const { return source_->chosen_frame(); }
    // A map stands still: every frame is the same.
    bool is_still() const { return !source_->frame_count(); }
    Camera camera() const { return source_->camera(frame()); }
    std::vector<std::string> notes() const { return source_->notes(); }

    // Of all that decides what a converged picture looks like: module, scene, files, camera, size, settings.
    uint64_t content_hash() const;

    // The next draws are by `variant`. Averaged: the same frame again and again, from `seed`; live: frames as in the
    // game, whose filters have forgotten what was before.
    void begin_averaged(const Variant& variant, int seed);
    void begin_live(const Variant& variant);
    FrameTime draw(int frame);
    analysis::LinearImage capture() const;

private:
    void set(const char* name, const std::string& value) { host_.cvars().set(name, value); }
    void set(const Variant& variant);

    FileSystem files_;
    std::unique_ptr<FrameSource> source_;
    Host host_;
    ModuleInfo info_;
    std::string scene_, settings_;
};

} // namespace vkpt::client
