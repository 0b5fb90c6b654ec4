// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

Session::Session(const std::filesystem::path& base_folder, const CvarList& cvars, glm::ivec2 size)
    : view {}
    , files_(base_folder, "")
{
    // All tests share one cache of compiled shaders, apart from the user's.
    setenv("XDG_CACHE_HOME", VKPT_TEST_CACHE, 1);
    client::HostOptions options;
    options.module = VKPT_TESTED_MODULE;
    options.width = size.x;
    options.height = size.y;
    options.cvars = { { "pt_validation", "1" }, { "pt_seed", "1" }, { "pt_exposure", "1" }, { "flt_denoiser", "off" },
        { "flt_taa", "off" } };
    options.cvars.insert(options.cvars.end(), cvars.begin(), cvars.end());
    options.on_line = [this](const std::string& line) {
        lines_.push_back(line);
        if (line.find("vkpt validation:") != std::string::npos)
            ADD_FAILURE() << line;
    };
    host_ = std::make_unique<client::Host>(options, &files_);
    for (size_t style = 0; style < lightstyles_.size(); style++)
        light_style(style, 1);
    view.width = size.x;
    view.height = size.y;
    view.lightstyles = lightstyles_.data();
    look({ 0, 0, 0 }, { 1, 0, 0 });
}

Session::Session(const GameFolder& folder, const CvarList& cvars, glm::ivec2 size)
    : Session(folder.path(), cvars, size)
{
}

Session::~Session() = default;

bool Session::has_line(std::string_view part) const
{
    return std::ranges::any_of(lines_, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

void Session::set(const std::string& name, double value) { set(name, fmt::format("{:.9g}", value)); }

void Session::load_map(const std::string& name, const std::string& sky)
{
    const float axis[3] = { 0, 0, 1 };
    module().begin_registration(name.c_str());
    module().register_model(fmt::format("maps/{}.bsp", name).c_str());
    module().set_sky(sky.c_str(), 0, axis);
    module().end_registration();
}

void Session::look(glm::vec3 eye, glm::vec3 target, float fov_x)
{
    const glm::vec3 d = target - eye;
    for (int i = 0; i < 3; i++)
        view.view_origin[i] = eye[i];
    view.view_angles[0] = glm::degrees(std::atan2(-d.z, std::hypot(d.x, d.y)));
    view.view_angles[1] = glm::degrees(std::atan2(d.y, d.x));
    view.fov_x = fov_x;
    const float tangent_y = std::tan(glm::radians(fov_x) / 2) * float(view.height) / float(view.width);
    view.fov_y = glm::degrees(2 * std::atan(tangent_y));
}

void Session::light_style(size_t style, float scale) { lightstyles_[style] = { { scale, scale, scale }, 3 * scale }; }

void Session::draw(int frames)
{
    for (int frame = 0; frame < frames; frame++)
        host_->draw_frame(view);
}

Radiance Session::capture()
{
    const ImageSize size = extension().frame_size();
    Radiance picture { size.width, size.height, std::vector<glm::vec3>(size_t(size.width) * size_t(size.height)) };
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    if (!extension().capture_radiance(&picture.pixels.data()->x))
        ADD_FAILURE() << "there is no radiance to capture";
    return picture;
}

Radiance Session::accumulate(int frames)
{
    set("pt_accumulate", "0");
    draw();
    set("pt_accumulate", "1");
    draw(frames);
    EXPECT_EQ(extension().accumulated_frames(), uint32_t(frames));
    return capture();
}

std::vector<std::string> Session::timed_passes()
{
    size_t count = 0;
    const PassTime* times = extension().pass_times(&count);
    std::vector<std::string> names;
    for (size_t i = 0; i < count; i++)
        names.emplace_back(times[i].name);
    return names;
}

formats::Image Session::capture_display()
{
    const ImageSize size = extension().frame_size();
    formats::Image image { size.width, size.height,
        std::vector<formats::Rgba8>(size_t(size.width) * size_t(size.height)) };
    if (!extension().capture_display(&image.pixels.data()->r))
        ADD_FAILURE() << "there is no frame to capture";
    return image;
}

std::vector<glm::vec3> Session::probe(std::span<const IrradianceProbe> probes, uint32_t samples)
{
    draw(); // the scene that is measured, and the cvars that are read
    std::vector<glm::vec3> result(probes.size());
    if (!extension().measure_irradiance(probes.data(), probes.size(), samples, &result.data()->x))
        ADD_FAILURE() << "there is no map to measure in";
    return result;
}

engine::Entity make_entity(void* model, glm::vec3 origin, int32_t flags)
{
    engine::Entity entity {};
    entity.model = model;
    for (int i = 0; i < 3; i++)
        entity.origin[i] = entity.previous_origin[i] = origin[i];
    entity.alpha = 1;
    entity.flags = flags;
    return entity;
}

} // namespace vkpt::tests
