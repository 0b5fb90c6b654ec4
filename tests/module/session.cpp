// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/session.hpp"

#include "shaders/shared/light_sampler.h"

#include "client/host/imports.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/test_cache.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

std::unique_ptr<Session::Running> Session::idle_;

namespace {

// Of the module's settings, those that it reads once, and of the environment that it starts in what tests change.
std::vector<std::string> start_settings(const CvarList& cvars)
{
    std::vector<std::string> key;
    for (const char* variable : { "VKPT_CACHE_DIR", "VKPT_FILL_MEMORY" })
        if (const char* value = std::getenv(variable))
            key.push_back(std::string(variable) + "=" + value);
    for (const auto& [name, value] : cvars)
        for (const char* read_once :
            { "pt_device", "pt_device_rays", "pt_photo_save", "pt_shader_dir", "pt_table_reads", "pt_validation" })
            if (name == read_once)
                key.push_back(name + "=" + value);
    return key;
}

// A map of one plain face.
std::filesystem::path between_sessions()
{
    static const GameFolder folder;
    if (const auto path = folder.path() / "baseq2/maps/between_sessions.bsp"; std::filesystem::exists(path))
        return path;
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 8, 0, 0 }, { 0, 8, 0 }), map.add_material("between_sessions"));
    folder.add_map("between_sessions", map.finish());
    return folder.path() / "baseq2/maps/between_sessions.bsp";
}

// The last module ends with the tests, while the driver is still whole.
class LastModule : public testing::Environment {
    void TearDown() override { Session::end_idle(); }
};
const testing::Environment* const last_module = testing::AddGlobalTestEnvironment(new LastModule);

} // namespace

Session::Session(const std::filesystem::path& base_folder, const CvarList& cvars, glm::ivec2 size)
    : view {}
    , files_(base_folder, "")
{
    // All tests share one cache of compiled shaders, apart from the user's.
    setenv("XDG_CACHE_HOME", VKPT_TEST_CACHE, 1);
    use_shared_cache();
    CvarList all { { "pt_validation", "1" }, { "pt_seed", "1" }, { "pt_exposure", "1" }, { "flt_denoiser", "off" },
        { "flt_taa", "off" } };
    all.insert(all.end(), cvars.begin(), cvars.end());
    std::vector<std::string> key = start_settings(all);
    std::filesystem::path font = base_folder / "baseq2/pics/conchars.pcx";
    const bool has_font = std::filesystem::exists(font);
    if (idle_ && idle_->key == key && (!has_font || idle_->font.empty() || idle_->font == font))
        take_over(all, size);
    else
        start(all, size, std::move(key));
    if (has_font)
        running_->font = std::move(font);
    for (size_t style = 0; style < lightstyles_.size(); style++)
        light_style(style, 1);
    view.width = size.x;
    view.height = size.y;
    view.lightstyles = lightstyles_.data();
    look({ 0, 0, 0 }, { 1, 0, 0 });
}

void Session::start(const CvarList& cvars, glm::ivec2 size, std::vector<std::string> key)
{
    end_idle(); // one at a time
    running_ = std::make_unique<Running>();
    running_->key = std::move(key);
    running_->session = this;
    client::HostOptions options;
    options.module = VKPT_TESTED_MODULE;
    options.width = size.x;
    options.height = size.y;
    options.cvars = cvars;
    options.on_line = [running = running_.get()](const std::string& line) {
        if (running->session)
            running->session->lines_.push_back(line);
        if (line.find("vkpt validation:") != std::string::npos)
            ADD_FAILURE() << line;
    };
    running_->host = std::make_unique<client::Host>(options, &files_);
}

void Session::take_over(const CvarList& cvars, glm::ivec2 size)
{
    running_ = std::move(idle_);
    client::HostImports::use_files(host(), &files_);
    if (size != glm::ivec2(host().width(), host().height()))
        client::HostImports::resize(host(), size.x, size.y);
    // All but the window's, which the host has set.
    constexpr std::string_view kept[] = { "r_mode", "r_customwidth", "r_customheight", "vid_fullscreen", "r_vsync" };
    for (const CvarRow& row : cvar_rows)
        if (std::ranges::find(kept, row.name) == std::end(kept))
            set(row.name, std::string(row.initial));
    for (const auto& [name, value] : cvars)
        set(name, value);
    // Another level: whatever the last one held goes.
    files_.add_file("maps/between_sessions.bsp", between_sessions());
    load_map("between_sessions");
    extension().forget_times();
    running_->session = this;
}

Session::Session(const GameFolder& folder, const CvarList& cvars, glm::ivec2 size)
    : Session(folder.path(), cvars, size)
{
}

Session::~Session()
{
    if (!running_)
        return;
    running_->session = nullptr;
    client::HostImports::use_files(host(), nullptr);
    idle_ = std::move(running_);
}

void Session::end_idle() { idle_ = nullptr; }

bool Session::has_line(std::string_view part) const
{
    return std::ranges::any_of(lines_, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

std::string Session::info_line(std::string_view label)
{
    const size_t before = lines_.size();
    host().run_text("pt_info\n");
    const auto line = std::find_if(lines_.begin() + std::ptrdiff_t(before), lines_.end(),
        [&](const std::string& text) { return text.starts_with(label); });
    return line == lines_.end() ? std::string() : *line;
}

double Session::info_number(std::string_view label)
{
    const std::string line = info_line(label);
    const size_t number = line.find_first_of("0123456789", std::min(label.size(), line.size()));
    return number == line.npos ? 0 : std::stod(line.substr(number));
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
        host().draw_frame(view);
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

std::vector<std::string> unbiased_samplers(const ModuleInfo& info)
{
    std::vector<std::string> names;
    for (size_t i = 0; info.light_samplers[i]; i++)
        if (!(info.light_sampler_traits[i] & shared::SAMPLER_BIASED))
            names.emplace_back(info.light_samplers[i]);
    return names;
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
