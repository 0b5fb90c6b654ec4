// SPDX-License-Identifier: GPL-2.0-or-later
// The module on a thread of its own, so that the window answers while a frame takes long. One request at a time.
#pragma once

#include "client/analysis/error.hpp"
#include "client/host/frame_source.hpp"
#include "client/view/error.hpp"
#include "client/view/settings.hpp"
#include "formats/image.hpp"

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <glm/vec2.hpp>
#include <mutex>
#include <optional>
#include <thread>

namespace vkpt::client::view {

// The pictures that are drawn in turn; numbers as of Extension::select_view.
enum class Side : uint32_t { a, b, reference };
inline constexpr size_t side_count = 3;

struct RenderRequest {
    Side side = Side::a;
    Settings settings;
    std::optional<Camera> camera; // nothing: the frame's own
    int frame = 0;
    bool starts_anew = false; // the reference: average from here on
    bool compares = false; // with the reference
    bool reloads_shaders = false;
    std::optional<glm::ivec2> inspected; // pixel of the picture
};

struct PassRow {
    std::string name;
    double milliseconds = 0;
};

struct Inspection {
    glm::ivec2 pixel { 0 };
    InspectedSurface surface {};
    std::vector<InspectedLight> lights; // the most probable first
    std::string sampler;
};

struct RenderedFrame {
    Side side = Side::a;
    formats::Image picture; // not of the reference
    Camera camera; // that it was seen from
    int frame = 0;
    double milliseconds = 0; // of the whole frame, for the CPU
    std::vector<PassRow> passes;
    uint32_t averaged_frames = 0;
    std::string backend;
    std::optional<analysis::ImageError> error;
    uint32_t reference_frames = 0;
    std::optional<double> reference_rmse; // of the reference itself
    std::optional<Inspection> inspection;
    Settings asked, used; // they differ where the module put a value right
};

struct SceneFacts {
    std::string device, driver;
    std::vector<std::string> light_samplers, backends;
    Settings settings; // every console variable that the module asked for
    std::optional<int> frame_count;
    int first_frame = 0;
    Camera camera;
    std::vector<std::string> notes;
};

struct RenderThreadOptions {
    HostOptions host;
    std::string scene; // as the user wrote it
    // Used by the render thread alone while that lives.
    FileSystem* files = nullptr;
    FrameSource* source = nullptr;
};

class RenderThread {
public:
    // `on_news` is called on the other thread whenever there is something to take.
    RenderThread(const RenderThreadOptions& options, std::function<void()> on_news);
    // Waits for the frame in progress.
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    // Each throws what ended the thread.
    std::optional<SceneFacts> take_facts();
    std::optional<RenderedFrame> take_frame();
    // What the module said since the last call.
    std::vector<std::string> take_lines();
    bool is_idle(); // ready, and nothing left to take
    void submit(RenderRequest request);

private:
    void run(const RenderThreadOptions& options);
    void serve(Host& host, FrameSource& source);
    void publish(const std::function<void()>& change);
    void throw_failure();

    std::function<void()> on_news_;
    std::mutex mutex_;
    std::condition_variable wakes_;
    std::optional<RenderRequest> request_;
    bool is_ready_ = false, is_busy_ = false, must_end_ = false;
    std::optional<SceneFacts> facts_;
    std::optional<RenderedFrame> frame_;
    std::vector<std::string> lines_;
    std::exception_ptr failure_;
    std::thread thread_; // last: it uses the others
};

} // namespace vkpt::client::view
