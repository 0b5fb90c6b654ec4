// SPDX-License-Identifier: GPL-2.0-or-later
// Shaders that are edited while frames go on (pt_shader_dir): those in use are compiled from the folder, on a thread of
// their own, once at first and again when a file changes. What does not compile leaves the shader before in place.
#pragma once

#include "ref_vkpt/vulkan/pipelines.hpp"
#include "ref_vkpt/vulkan/shader_folder.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkpt {

class ShaderReload {
public:
    // `folder`: empty: nothing is compiled. Tells the console where it is no folder.
    ShaderReload(const std::string& folder, Pipelines& pipelines);
    ~ShaderReload();
    ShaderReload(const ShaderReload&) = delete;
    ShaderReload& operator=(const ShaderReload&) = delete;

    bool is_on() const { return folder_.has_value(); }
    // The command reload_shader: what the next look at the files finds is told, whatever it is.
    void look();
    // Between frames. `shaders`: those of the next frame, as far as they are known. `finish` waits for the device.
    // `waits`: until all are compiled. True: some shader is another one now.
    bool update(std::vector<std::string> shaders, bool waits, const std::function<void()>& finish);

    // Of the last compilation, to be shown; empty: all is well.
    const std::vector<std::string>& errors() const { return error_lines_; }

private:
    struct Compiled {
        std::map<std::string, std::vector<uint32_t>> code;
        std::map<std::string, std::string> errors; // by shader
        double seconds = 0;
    };
    using Clock = std::chrono::steady_clock;

    bool is_new(const std::string& shader);
    Compiled compile_new(const std::vector<std::string>& shaders);
    bool take(const Compiled& compiled, const std::function<void()>& finish);
    void note_error(const std::string& shader, const std::string& text);
    void tell_errors();

    Pipelines& pipelines_;
    std::map<std::string, std::string> errors_; // by shader
    std::vector<std::string> error_lines_;
    std::vector<std::string> looked_at_; // shaders
    Clock::time_point next_look_ {};
    bool is_asked_ = false; // what is found is to be told

    // Of the thread that compiles, while there is one.
    std::optional<ShaderFolder> folder_;
    std::map<std::string, ShaderFolder::Files> compiled_; // by shader: its files then
    std::atomic<bool> must_end_ = false;
    std::future<Compiled> running_; // last: it uses the others
};

} // namespace vkpt
