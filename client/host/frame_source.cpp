// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/frame_source.hpp"

#include "client/host/errors.hpp"
#include "client/host/trace_frames.hpp"
#include "common/numbers.hpp"

#include <fmt/format.h>
#include <utility>

namespace vkpt::client {

namespace {

// A map as a player first sees it, at 60 frames a second, for ever.
class MapFrames final : public FrameSource {
public:
    MapFrames(FileSystem& files, std::string_view name)
        : scene_(files, parse_scene_name(name))
        , own_camera_(scene_.camera())
    {
    }

    void register_with(Host& host) override { scene_.register_with(host); }
    std::optional<int> frame_count() const override { return std::nullopt; }
    int chosen_frame() const override { return 0; }
    double seconds(int frame) const override { return frame / frames_per_second; }
    Camera camera(int) const override { return scene_.camera(); }
    void set_camera(const std::optional<Camera>& camera) override { scene_.set_camera(camera.value_or(own_camera_)); }
    std::vector<std::string> notes() const override { return scene_.notes(); }

private:
    static constexpr double frames_per_second = 60;

    void draw_frame(Host& host, int frame) override
    {
        host.draw_frame(scene_.view(host.width(), host.height(), float(seconds(frame))));
    }

    ClientMap scene_;
    const Camera own_camera_;
};

int parse_frame(std::string_view text, std::string_view whole)
{
    if (text.empty())
        return 0;
    const std::optional<int> frame = parse_number<int>(text.substr(1));
    if (!frame || *frame < 0)
        throw WrongUse(fmt::format(
            "\"{}\": \"{}\" is not a frame number; write FILE.rtrace@0 for the first", whole, text.substr(1)));
    return *frame;
}

} // namespace

void FrameSource::draw(Host& host, int frame)
{
    if (std::exchange(last_frame_, frame) != frame)
        host.extension().thaw_scene();
    draw_frame(host, frame);
}

std::unique_ptr<FrameSource> open_frame_source(FileSystem& files, std::string_view scene)
{
    const std::string_view file = scene.substr(0, scene.rfind('@'));
    if (file.ends_with(".rtrace"))
        return std::make_unique<TraceFrames>(files, file, parse_frame(scene.substr(file.size()), scene));
    if (file.ends_with(".bsp"))
        return std::make_unique<MapFrames>(files, scene);
    throw WrongUse(fmt::format(
        "\"{}\" is not a scene: write maps/NAME.bsp, maps/NAME.bsp@x,y,z,pitch,yaw, FILE.rtrace or FILE.rtrace@FRAME",
        scene));
}

} // namespace vkpt::client
