// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/shader_reload.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace vkpt {

namespace {

constexpr std::chrono::milliseconds watch_interval { 300 };
constexpr size_t max_shown_lines = 12;

} // namespace

ShaderReload::ShaderReload(const std::string& folder, Pipelines& pipelines)
    : pipelines_(pipelines)
{
    try {
        if (!folder.empty())
            folder_.emplace(folder);
    } catch (const ShaderError& error) {
        engine::print("ref_vkpt: {}", error.what());
    }
}

ShaderReload::~ShaderReload() { must_end_ = true; }

void ShaderReload::look()
{
    if (!folder_) {
        engine::print("ref_vkpt: shaders are those of the build: start with +set pt_shader_dir FOLDER to edit them");
        return;
    }
    is_asked_ = true;
    looked_at_.clear();
}

// Whether the shader was not compiled from its files as they are now.
bool ShaderReload::is_new(const std::string& shader)
{
    const ShaderFolder::Files before = std::exchange(compiled_[shader], {});
    return (compiled_[shader] = folder_->find_files(shader)) != before;
}

ShaderReload::Compiled ShaderReload::compile_new(const std::vector<std::string>& shaders)
{
    const Clock::time_point begin = Clock::now();
    Compiled compiled;
    for (const std::string& shader : shaders)
        try {
            if (!must_end_ && is_new(shader))
                compiled.code[shader] = folder_->compile(shader);
        } catch (const std::exception& error) { // ShaderError, or what the file system has to say
            compiled.code.erase(shader);
            compiled.errors[shader] = error.what();
        }
    compiled.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return compiled;
}

void ShaderReload::note_error(const std::string& shader, const std::string& text)
{
    if (std::string& known = errors_[shader]; known != text) {
        known = text;
        is_asked_ = true; // it is told
    }
}

// Shaders that share a file have its errors in common.
void ShaderReload::tell_errors()
{
    error_lines_.clear();
    std::set<std::string> told;
    for (const auto& [shader, text] : errors_) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
            if (!line.empty() && told.insert(line).second) {
                engine::print("ref_vkpt: {}", line);
                if (error_lines_.size() < max_shown_lines)
                    error_lines_.push_back(line);
            }
    }
}

bool ShaderReload::take(const Compiled& compiled, const std::function<void()>& finish)
{
    size_t replaced = 0;
    for (const auto& [shader, text] : compiled.errors)
        note_error(shader, text);
    for (const auto& [shader, code] : compiled.code)
        try {
            is_asked_ |= errors_.erase(shader) > 0;
            replaced += pipelines_.replace(shader, code, finish);
        } catch (const std::exception& error) {
            note_error(shader, fmt::format("{}: {}", shader, error.what()));
        }
    if (replaced > 0)
        engine::print(
            "ref_vkpt: {} shaders changed, {} compiled in {:.1f} s", replaced, compiled.code.size(), compiled.seconds);
    if (std::exchange(is_asked_, false)) {
        tell_errors();
        if (errors_.empty())
            engine::print("ref_vkpt: all shaders in use are those of {}", folder_->path());
    }
    return replaced > 0;
}

bool ShaderReload::update(std::vector<std::string> shaders, bool waits, const std::function<void()>& finish)
{
    if (!folder_)
        return false;
    bool is_new = false;
    if (running_.valid() && (waits || running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready))
        is_new = take(running_.get(), finish);
    std::ranges::move(pipelines_.used_shaders(), std::back_inserter(shaders));
    std::ranges::sort(shaders);
    shaders.erase(std::ranges::unique(shaders).begin(), shaders.end());
    if (!running_.valid() && (Clock::now() >= next_look_ || shaders != looked_at_)) {
        next_look_ = Clock::now() + watch_interval;
        looked_at_ = shaders;
        running_
            = std::async(std::launch::async, [this, shaders = std::move(shaders)] { return compile_new(shaders); });
        if (waits)
            is_new |= take(running_.get(), finish);
    }
    return is_new;
}

} // namespace vkpt
