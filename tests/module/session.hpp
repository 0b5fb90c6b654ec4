// SPDX-License-Identifier: GPL-2.0-or-later
// One run of the real module: started with validation, a map registered, frames drawn, pictures taken.
// Any line of the validation layers fails the running test.
// A start takes seconds, nearly all of them for shaders. So a module that a session has left is taken over by the next
// one that wants the same settings, without its map, every cvar at its default, the console empty, in a size of its
// own.
#pragma once

#include "client/host/host.hpp"
#include "tests/module/game_folder.hpp"
#include "tests/module/picture.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace vkpt::tests {

using CvarList = std::vector<std::pair<std::string, std::string>>;
inline const CvarList matte { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } }; // and direct light alone

class Session {
public:
    // Pictures are repeatable (pt_seed 1), not exposed automatically and not filtered, unless `cvars` say otherwise.
    explicit Session(
        const std::filesystem::path& base_folder, const CvarList& cvars = {}, glm::ivec2 size = { 64, 48 });
    explicit Session(const GameFolder& folder, const CvarList& cvars = {}, glm::ivec2 size = { 64, 48 });
    ~Session();
    // The next session's module is a new one.
    static void end_idle();

    client::Host& host() { return *running_->host; }
    client::FileSystem& files() { return files_; }
    const engine::Exports8& module() { return host().module(); }
    const Extension& extension() { return host().extension(); }
    const std::vector<std::string>& lines() const { return lines_; } // the console's
    bool has_line(std::string_view part) const;
    // The line of pt_info that begins so; empty: there is none.
    std::string info_line(std::string_view label);
    // The first number of that line; 0: there is none.
    double info_number(std::string_view label);

    void set(const std::string& name, const std::string& value) { host().cvars().set(name, value); }
    void set(const std::string& name, double value);
    // As the engine's client registers maps/NAME.bsp. Throws client::Failure where the module drops the level.
    void load_map(const std::string& name, const std::string& sky = "none");
    void look(glm::vec3 eye, glm::vec3 target, float fov_x = 90);
    void light_style(size_t style, float scale);

    engine::RefDef view; // what is drawn: the whole picture, every lightstyle at 1
    void draw(int frames = 1);
    Radiance capture();
    // A converged picture: `frames` frames averaged from the start.
    Radiance accumulate(int frames);
    formats::Image capture_display();
    // Of the last frame that they were timed in, in order.
    std::vector<std::string> timed_passes();
    // Irradiance / pi.
    std::vector<glm::vec3> probe(std::span<const IrradianceProbe> probes, uint32_t samples);

private:
    // A started module, and the session that has it now.
    struct Running {
        std::vector<std::string> key; // what cannot be changed without a new start
        std::filesystem::path font; // that it has read, which stays from map to map; or none
        std::unique_ptr<client::Host> host;
        Session* session = nullptr;
    };
    static std::unique_ptr<Running> idle_;

    void start(const CvarList& cvars, glm::ivec2 size, std::vector<std::string> key);
    void take_over(const CvarList& cvars, glm::ivec2 size);

    std::vector<std::string> lines_;
    client::FileSystem files_;
    std::unique_ptr<Running> running_;
    std::array<engine::Lightstyle, engine::max_lightstyles> lightstyles_ {};
};

// Biased ones are there to be compared: their pictures are wrong.
std::vector<std::string> unbiased_samplers(const ModuleInfo& info);

engine::Entity make_entity(void* model, glm::vec3 origin, int32_t flags = 0);

} // namespace vkpt::tests
