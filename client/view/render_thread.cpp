// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/render_thread.hpp"

#include "client/host/errors.hpp"
#include "client/host/name_list.hpp"
#include "ref_vkpt/cvars_rows.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace vkpt::client::view {

namespace {

constexpr size_t max_inspected_lights = 4096;

Settings read_settings(Host& host)
{
    Settings settings;
    for (const CvarRow& row : cvar_rows)
        if (const engine::Cvar* cvar = host.cvars().find(row.name))
            settings[row.name] = cvar->text;
    return settings;
}

SceneFacts find_facts(Host& host, const FrameSource& source)
{
    const ModuleInfo info = host.extension().info();
    SceneFacts facts;
    facts.device = info.device;
    facts.driver = info.driver;
    facts.light_samplers = list_names(info.light_samplers);
    facts.backends = list_names(info.trace_backends);
    facts.settings = read_settings(host);
    facts.frame_count = source.frame_count();
    facts.first_frame = source.chosen_frame();
    facts.camera = source.camera(facts.first_frame);
    facts.notes = source.notes();
    return facts;
}

// Draws what is asked for. On the render thread.
class Renderer {
public:
    Renderer(Host& host, FrameSource& source)
        : host_(host)
        , extension_(host.extension())
        , source_(source)
    {
    }

    RenderedFrame draw(const RenderRequest& request)
    {
        const auto start = std::chrono::steady_clock::now();
        extension_.select_view(uint32_t(request.side));
        // Another moment's things: what was averaged shows them no longer.
        std::optional<int>& last_frame = last_frames_[size_t(request.side)];
        if (request.starts_anew || last_frame != request.frame)
            extension_.thaw_scene();
        last_frame = request.frame;
        for (const auto& [name, value] : request.settings)
            if (const engine::Cvar* cvar = host_.cvars().find(name); cvar && cvar->text != value)
                host_.cvars().set(name, value);
        if (request.reloads_shaders)
            host_.run_text("reload_shader\n");
        source_.set_camera(request.camera);
        source_.draw(host_, request.frame);
        RenderedFrame result;
        result.side = request.side;
        result.frame = request.frame;
        result.camera = source_.camera(request.frame);
        read_passes(result);
        const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
        result.milliseconds = passed.count();
        result.averaged_frames = extension_.accumulated_frames();
        result.backend = extension_.info().trace_backend;
        result.asked = request.settings;
        result.used = read_settings(host_);
        if (request.side == Side::reference)
            update_reference(request);
        else
            capture(result, request);
        result.reference_frames = reference_.frames();
        result.reference_rmse = reference_.own_rmse();
        return result;
    }

private:
    void read_passes(RenderedFrame& result) const
    {
        size_t count = 0;
        const PassTime* times = extension_.pass_times(&count); // waits for the device
        for (size_t i = 0; i < count; i++)
            result.passes.push_back({ times[i].name, times[i].milliseconds });
    }

    // Nothing: the frame had no 3D view.
    std::optional<analysis::LinearImage> read_radiance() const
    {
        const ImageSize size = extension_.frame_size();
        analysis::LinearImage image = analysis::make_image(size.width, size.height);
        if (!extension_.capture_radiance(image.rgb.data()))
            return std::nullopt;
        return image;
    }

    void update_reference(const RenderRequest& request)
    {
        if (request.starts_anew)
            reference_.restart();
        if (auto average = read_radiance())
            reference_.update(std::move(*average), extension_.accumulated_frames());
    }

    void capture(RenderedFrame& result, const RenderRequest& request) const
    {
        const ImageSize size = extension_.frame_size();
        result.picture
            = { size.width, size.height, std::vector<formats::Rgba8>(size_t(size.width) * size_t(size.height)) };
        if (!extension_.capture_display(&result.picture.pixels.data()->r))
            throw Failure("the module has no finished frame to show");
        if (request.compares)
            result.error = compare();
        if (request.inspected)
            result.inspection = inspect(*request.inspected, request.settings);
    }

    // Nothing: no reference yet, or one of another size.
    std::optional<analysis::ImageError> compare() const
    {
        const analysis::LinearImage& reference = reference_.average();
        const auto picture = read_radiance();
        if (reference_.frames() == 0 || !picture || picture->width != reference.width
            || picture->height != reference.height)
            return std::nullopt;
        return analysis::measure_error(reference, *picture);
    }

    std::optional<Inspection> inspect(glm::ivec2 pixel, const Settings& settings) const
    {
        Inspection result;
        result.pixel = pixel;
        result.lights.resize(max_inspected_lights);
        if (!extension_.inspect_pixel(
                uint32_t(pixel.x), uint32_t(pixel.y), &result.surface, result.lights.data(), result.lights.size()))
            return std::nullopt;
        result.lights.resize(std::min<size_t>(result.lights.size(), result.surface.light_count));
        std::ranges::stable_sort(result.lights, [](const InspectedLight& a, const InspectedLight& b) {
            return std::pair(a.probability, a.weight) > std::pair(b.probability, b.weight);
        });
        if (const auto sampler = settings.find("pt_light_sampler"); sampler != settings.end())
            result.sampler = sampler->second;
        return result;
    }

    Host& host_;
    const Extension& extension_;
    FrameSource& source_;
    std::array<std::optional<int>, side_count> last_frames_;
    Reference reference_;
};

} // namespace

RenderThread::RenderThread(const RenderThreadOptions& options, std::function<void()> on_news)
    : on_news_(std::move(on_news))
    , thread_([this, options] { run(options); })
{
}

RenderThread::~RenderThread()
{
    {
        const std::lock_guard lock(mutex_);
        must_end_ = true;
    }
    wakes_.notify_all();
    thread_.join();
}

void RenderThread::publish(const std::function<void()>& change)
{
    {
        const std::lock_guard lock(mutex_);
        change();
    }
    on_news_();
}

void RenderThread::run(const RenderThreadOptions& options)
{
    try {
        HostOptions host_options = options.host;
        host_options.on_line = [this](const std::string& line) { publish([&] { lines_.push_back(line); }); };
        Host host(host_options, options.files);
        options.source->register_with(host);
        host.extension().time_every_pass();
        SceneFacts facts = find_facts(host, *options.source);
        publish([&] {
            facts_ = std::move(facts);
            is_ready_ = true;
        });
        serve(host, *options.source);
    } catch (...) {
        publish([&] { failure_ = std::current_exception(); });
    }
}

void RenderThread::serve(Host& host, FrameSource& source)
{
    Renderer renderer(host, source);
    while (true) {
        RenderRequest request;
        {
            std::unique_lock lock(mutex_);
            wakes_.wait(lock, [this] { return must_end_ || request_; });
            if (must_end_)
                return;
            request = std::move(*request_);
            request_.reset();
        }
        RenderedFrame frame = renderer.draw(request);
        publish([&] {
            frame_ = std::move(frame);
            is_busy_ = false;
        });
    }
}

void RenderThread::throw_failure()
{
    if (failure_)
        std::rethrow_exception(failure_);
}

std::optional<SceneFacts> RenderThread::take_facts()
{
    const std::lock_guard lock(mutex_);
    throw_failure();
    return std::exchange(facts_, std::nullopt);
}

std::optional<RenderedFrame> RenderThread::take_frame()
{
    const std::lock_guard lock(mutex_);
    throw_failure();
    return std::exchange(frame_, std::nullopt);
}

std::vector<std::string> RenderThread::take_lines()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
}

bool RenderThread::is_idle()
{
    const std::lock_guard lock(mutex_);
    return is_ready_ && !is_busy_ && !facts_ && !frame_;
}

void RenderThread::submit(RenderRequest request)
{
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
        is_busy_ = true;
    }
    wakes_.notify_all();
}

} // namespace vkpt::client::view
