// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/imports.hpp"

#include "client/host/errors.hpp"
#include "client/host/host.hpp"
#include "client/host/output_file.hpp"
#include "formats/image.hpp"

#include <algorithm>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace vkpt::client {

namespace {

Host* host = nullptr;

std::string format_text(const char* format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, again);
    va_end(again);
    std::string text(size_t(std::max(length, 0)) + 1, '\0');
    std::vsnprintf(text.data(), text.size(), format, arguments);
    text.pop_back();
    return text;
}

// The engine would jump out of the module's frames; we unwind them.
void raise_error(int, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const std::string text = format_text(format, arguments);
    va_end(arguments);
    throw Failure(text);
}

void free_file(void* buffer) { std::free(buffer); }

std::vector<formats::Rgba8> to_rgba(int width, int height, int bytes_per_pixel, const void* pixels)
{
    const auto* source = static_cast<const uint8_t*>(pixels);
    std::vector<formats::Rgba8> rgba(size_t(width) * size_t(height));
    for (formats::Rgba8& pixel : rgba) {
        pixel = { source[0], source[1], source[2], 255 };
        source += bytes_per_pixel;
    }
    return rgba;
}

} // namespace

void HostImports::bind(Host* new_host) { host = new_host; }

void HostImports::resize(Host& resized, int width, int height)
{
    resized.options_.width = width;
    resized.options_.height = height;
    resized.cvars_.set("r_customwidth", std::to_string(width));
    resized.cvars_.set("r_customheight", std::to_string(height));
    resized.keeps_context_ = true;
    const bool is_on = engine::is_true(resized.exports_.init());
    resized.keeps_context_ = false;
    if (!is_on)
        throw Failure("the refresh module did not start again; it said:\n" + resized.console_tail());
}

void HostImports::use_files(Host& reader, FileSystem* files) { reader.files_ = files; }

void HostImports::add_commands(engine::Imports& imports)
{
    imports.error = raise_error;
    imports.add_command = [](const char* name, void (*function)()) { host->commands_[name] = function; };
    imports.remove_command = [](const char* name) { host->commands_.erase(name); };
    imports.argument_count = [] { return int(host->arguments_.size()); };
    imports.argument = [](int index) -> const char* {
        return index >= 0 && size_t(index) < host->arguments_.size() ? host->arguments_[size_t(index)].c_str() : "";
    };
    imports.execute_text = [](int when, const char* text) {
        if (when == engine::EXEC_NOW)
            host->run_text(text);
        else if (when == engine::EXEC_INSERT)
            host->pending_text_.insert(0, std::string(text) + "\n");
        else
            host->pending_text_ += std::string(text) + "\n";
    };
    imports.print = [](int level, const char* format, va_list arguments) {
        if (level != engine::PRINT_DEVELOPER || host->options_.verbose)
            host->add_console_text(format_text(format, arguments));
    };
}

void HostImports::add_files(engine::Imports& imports)
{
    imports.load_file = [](const char* path, void** buffer) -> int {
        const auto size = host->files_ ? host->files_->size(path) : std::nullopt;
        if (!size || !buffer)
            return size ? int(std::min<uint64_t>(*size, INT_MAX)) : -1;
        const auto bytes = host->files_->read(path);
        if (!bytes || bytes->size() > size_t(INT_MAX))
            return -1;
        *buffer = std::malloc(std::max<size_t>(bytes->size(), 1));
        if (!*buffer)
            return -1;
        std::memcpy(*buffer, bytes->data(), bytes->size());
        return int(bytes->size());
    };
    imports.free_file = free_file;
    imports.game_directory = []() -> const char* { return host->write_folder_text_.c_str(); };
    imports.get_cvar
        = [](const char* name, const char* text, int flags) { return host->cvars_.get(name, text, flags); };
    imports.set_cvar = [](const char* name, const char* text) { return host->cvars_.set(name, text); };
    imports.set_cvar_number = [](const char* name, float number) { host->cvars_.set(name, fmt::format("{}", number)); };
}

void HostImports::add_video(engine::Imports& imports)
{
    // Every mode is the host's own size: there is no window to fit.
    imports.mode_info = [](int* width, int* height, int) -> engine::QBoolean {
        *width = host->options_.width;
        *height = host->options_.height;
        return 1;
    };
    imports.init_video_menu = [] {};
    imports.write_screenshot = [](int width, int height, int bytes_per_pixel, const void* pixels) {
        formats::Image image { width, height, to_rgba(width, height, bytes_per_pixel, pixels) };
        const auto file = host->write_folder_ / fmt::format("screenshot{:03}.png", host->screenshots_++);
        const std::vector<std::byte> png = formats::write_png(image);
        try {
            OutputFile output(file);
            output.write(png);
            output.commit();
            host->add_console_text(fmt::format("wrote {}\n", file.string()));
        } catch (const Failure& failure) {
            host->add_console_text(fmt::format("{}\n", failure.what()));
        }
    };
    imports.init_graphics = [](int, int* width, int* height) -> engine::QBoolean {
        if (!host->keeps_context_ && host->exports_.prepare_for_window() == -1)
            return 0;
        *width = host->options_.width;
        *height = host->options_.height;
        return host->keeps_context_ || host->exports_.init_context(nullptr) != 0;
    };
    imports.desktop_mode = [](int* width, int* height) -> engine::QBoolean {
        *width = host->options_.width;
        *height = host->options_.height;
        return 1;
    };
    imports.request_restart = [](int kind) {
        if (engine::Restart(kind) == engine::Restart::full || engine::Restart(kind) == engine::Restart::partial)
            host->add_console_text("this setting takes effect at the next start\n");
    };
}

engine::Imports HostImports::table()
{
    engine::Imports imports {};
    add_commands(imports);
    add_files(imports);
    add_video(imports);
    return imports;
}

} // namespace vkpt::client
