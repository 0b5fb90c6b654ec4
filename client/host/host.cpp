// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/host.hpp"

#include "client/host/companions.hpp"
#include "client/host/errors.hpp"
#include "client/host/imports.hpp"
#include "client/host/private_folder.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <fmt/format.h>
#include <ranges>
#include <set>
#include <string_view>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

constexpr size_t kept_console_lines = 100;
constexpr const char* played_version = "8.70 vkpt";

fs::path find_module(const fs::path& wanted)
{
    if (!wanted.empty())
        return wanted;
    if (const char* named = std::getenv("VKPT_MODULE"); named && *named)
        return named;
    return find_companion("ref_vkpt.so", "Build it, or name it with --module PATH or $VKPT_MODULE.");
}

// Words of a console line; "..." is one word.
std::vector<std::string> split_words(std::string_view line)
{
    std::vector<std::string> words;
    for (size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) < line.size();) {
        const bool is_quoted = line[at] == '"';
        at += is_quoted;
        const size_t end = std::min(line.find_first_of(is_quoted ? "\"" : " \t\r", at), line.size());
        words.emplace_back(line.substr(at, end - at));
        at = end + is_quoted;
    }
    return words;
}

} // namespace

Host::Host(const HostOptions& options, FileSystem* files)
    : options_(options)
    , files_(files)
{
    choose_write_folder();
    HostImports::bind(this);
    try {
        load_module(options.module);
        start_module();
        check_wanted_cvars();
    } catch (...) {
        if (is_started_)
            exports_.shutdown();
        HostImports::bind(nullptr);
        throw;
    }
}

Host::~Host()
{
    try {
        exports_.shutdown();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpt: while shutting down the module: %s\n", error.what());
    }
    HostImports::bind(nullptr);
}

// Where the module may keep its caches, and writes what it is told to.
void Host::choose_write_folder()
{
    const PrivateFolder cache = open_cache_folder();
    if (cache.path.empty()) {
        std::fprintf(stderr, "vkpt: nothing is cached for the next run: %s\n", cache.problem.c_str());
        temporary_folder_ = std::make_unique<SessionFolder>("vkpt-run-");
    }
    write_folder_ = temporary_folder_ ? temporary_folder_->path() : cache.path;
    write_folder_text_ = write_folder_.string();
}

void Host::load_module(const fs::path& wanted)
{
    module_path_ = fs::absolute(find_module(wanted));
    library_ = dlopen(module_path_.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library_)
        throw Failure(fmt::format("cannot load the refresh module: {}", dlerror()));
    const auto get_extension = reinterpret_cast<GetExtension>(dlsym(library_, "vkpt_extension"));
    extension_ = get_extension ? get_extension(extension_version) : nullptr;
    if (!extension_)
        throw Failure(fmt::format(
            "{} is not a ref_vkpt of this program's version: build both from one source tree", module_path_.string()));
    using GetRefApi = engine::Exports8 (*)(engine::Imports);
    const auto get_ref_api = reinterpret_cast<GetRefApi>(dlsym(library_, "GetRefAPI"));
    if (!get_ref_api)
        throw Failure(fmt::format("{} has no GetRefAPI: it is not a refresh module", module_path_.string()));
    cvars_.set("version", played_version);
    exports_ = get_ref_api(HostImports::table());
    if (exports_.api != 8)
        throw Failure(fmt::format("{} speaks API {}, and vkpt needs API 8", module_path_.string(), exports_.api));
}

void Host::start_module()
{
    cvars_.set("r_mode", "-1");
    cvars_.set("r_customwidth", std::to_string(options_.width));
    cvars_.set("r_customheight", std::to_string(options_.height));
    cvars_.set("vid_fullscreen", "0");
    cvars_.set("r_vsync", "0");
    for (const auto& [name, text] : options_.cvars)
        cvars_.set(name, text);
    is_started_ = true;
    if (!engine::is_true(exports_.init()))
        throw Failure("the refresh module did not start; it said:\n" + console_tail());
}

void Host::check_wanted_cvars()
{
    std::set<std::string_view> seen; // of several settings of one variable the last counts
    for (const auto& [name, text] : options_.cvars | std::views::reverse) {
        if (!seen.insert(name).second)
            continue;
        if (!cvars_.was_asked_for(name))
            throw WrongUse(
                fmt::format("--set {}={}: there is no such variable; `vkpt info --cvars` lists them", name, text));
        if (const std::string_view used = cvars_.find(name)->text; used != text)
            std::fprintf(stderr,
                "vkpt: --set %s=%s: the module uses %.*s instead; `vkpt info --cvars` lists the ranges\n", name.c_str(),
                text.c_str(), int(used.size()), used.data());
    }
    const engine::Cvar* projection = cvars_.find("pt_projection");
    if (projection && projection->text == std::string_view("equirectangular") && options_.width != 2 * options_.height)
        std::fprintf(stderr,
            "vkpt: an equirectangular image is twice as wide as high, so %dx%d is stretched; use --size %dx%d\n",
            options_.width, options_.height, 2 * options_.height, options_.height);
}

void Host::draw_frame(const engine::RefDef& refdef)
{
    run_left_text();
    exports_.begin_frame(0);
    exports_.render_frame(&refdef);
    exports_.end_frame();
}

bool Host::is_chosen(std::string_view cvar) const
{
    return std::ranges::any_of(options_.cvars, [&](const auto& chosen) { return chosen.first == cvar; });
}

void Host::run_text(std::string_view text)
{
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of("\n;"), text.size());
        run_line(split_words(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

void Host::run_line(const std::vector<std::string>& words)
{
    if (words.empty())
        return;
    if (const auto command = commands_.find(words[0]); command != commands_.end()) {
        arguments_ = words;
        command->second();
    } else if (words.size() == 3 && words[0] == "set") {
        cvars_.set(words[1], words[2]);
    } else if (words.size() == 2 && cvars_.find(words[0])) {
        cvars_.set(words[0], words[1]);
    } else {
        add_console_text(fmt::format("unknown command \"{}\"\n", words[0]));
    }
}

void Host::add_console_text(std::string_view text)
{
    for (const char c : text) {
        if (c != '\n') {
            console_line_ += c;
            continue;
        }
        // Who sets pt_validation wants to know what the layers say.
        if (options_.verbose || console_line_.starts_with("vkpt validation:"))
            std::fprintf(stderr, "%s\n", console_line_.c_str());
        if (options_.on_line)
            options_.on_line(console_line_);
        console_.push_back(std::exchange(console_line_, {}));
        if (console_.size() > kept_console_lines)
            console_.pop_front();
    }
}

std::string Host::console_tail() const
{
    constexpr size_t shown = 8;
    std::string tail;
    for (size_t i = console_.size() - std::min(console_.size(), shown); i < console_.size(); i++)
        tail += (tail.empty() ? "  " : "\n  ") + console_[i];
    return tail.empty() ? "  (nothing)" : tail;
}

} // namespace vkpt::client
