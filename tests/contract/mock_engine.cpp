// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/contract/mock_engine.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace vkpt::tests {

namespace {

MockEngine* mock = nullptr;
std::jmp_buf* landing = nullptr;
int raised_level = 0;
char raised_text[2048];

void raise_error(int level, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(raised_text, sizeof raised_text, format, arguments);
    va_end(arguments);
    raised_level = level;
    if (!landing) {
        std::fprintf(stderr, "error outside catch_error: %s\n", raised_text);
        std::abort();
    }
    std::longjmp(*landing, 1);
}

void print(int, const char* format, va_list arguments)
{
    char text[4096];
    std::vsnprintf(text, sizeof text, format, arguments);
    mock->console.emplace_back(text);
}

int load_file(const char* path, void** buffer)
{
    const auto found = mock->files.find(path);
    if (found == mock->files.end())
        return -1;
    if (buffer) {
        *buffer = std::malloc(found->second.size() + 1);
        std::memcpy(*buffer, found->second.c_str(), found->second.size() + 1);
        mock->files_loaded++;
        mock->files_out++;
        return int(found->second.size());
    }
    const auto told = mock->told_sizes.find(path);
    return told != mock->told_sizes.end() ? told->second : int(found->second.size());
}

void free_file(void* buffer)
{
    std::free(buffer);
    mock->files_out--;
}

engine::Cvar* set_cvar(const char* name, const char* text)
{
    mock->set(name, text);
    return &mock->variables[name].cvar;
}

engine::Cvar* get_cvar(const char* name, const char* text, int flags)
{
    mock->cvar_flags[name] |= flags;
    const auto found = mock->variables.find(name);
    return found == mock->variables.end() ? set_cvar(name, text) : &found->second.cvar;
}

engine::QBoolean mode_info(int* width, int* height, int mode)
{
    if (mode != 4)
        return mock->falsehood;
    *width = 800;
    *height = 600;
    return mock->truth;
}

engine::QBoolean init_graphics(int, int*, int*)
{
    if (!mock->window_works || (mock->make_window && !mock->make_window()))
        return mock->falsehood;
    return mock->truth;
}

} // namespace

MockEngine::MockEngine(const std::string& version)
{
    mock = this;
    set("version", version);
}

MockEngine::~MockEngine() { mock = nullptr; }

void MockEngine::set(const std::string& name, const std::string& text)
{
    Variable& variable = variables[name];
    variable.name = name;
    variable.text = text;
    variable.cvar.name = variable.name.data();
    variable.cvar.text = variable.text.data();
    variable.cvar.number = std::strtof(text.c_str(), nullptr);
}

std::string MockEngine::get(const std::string& name) const
{
    const auto found = variables.find(name);
    return found == variables.end() ? "(no such variable)" : found->second.text;
}

std::vector<std::string> MockEngine::lines_with(const std::string& part) const
{
    std::vector<std::string> lines;
    for (const std::string& line : console)
        if (line.find(part) != std::string::npos)
            lines.push_back(line);
    return lines;
}

engine::Imports MockEngine::imports() const
{
    engine::Imports imports {};
    imports.error = raise_error;
    imports.add_command = [](const char* name, void (*function)()) { mock->commands[name] = function; };
    imports.remove_command = [](const char* name) { mock->commands.erase(name); };
    imports.argument_count = [] { return int(mock->arguments.size()); };
    imports.argument = [](int index) { return mock->arguments.at(size_t(index)).c_str(); };
    imports.execute_text = [](int, const char*) {};
    imports.print = print;
    imports.load_file = load_file;
    imports.free_file = free_file;
    imports.game_directory = [] { return "mock"; };
    imports.get_cvar = get_cvar;
    imports.set_cvar = set_cvar;
    imports.set_cvar_number = [](const char* name, float number) { mock->set(name, std::to_string(number)); };
    imports.mode_info = mode_info;
    imports.init_video_menu = [] {};
    imports.write_screenshot = [](int, int, int, const void*) {};
    imports.init_graphics = init_graphics;
    imports.desktop_mode = [](int*, int*) { return mock->falsehood; };
    imports.request_restart = [](int kind) { mock->restart = kind; };
    return imports;
}

std::optional<RaisedError> catch_error(void (*call)(void* argument), void* argument)
{
    std::jmp_buf buffer;
    landing = &buffer;
    if (setjmp(buffer) == 0) {
        call(argument);
        landing = nullptr;
        return std::nullopt;
    }
    landing = nullptr;
    return RaisedError { raised_level, raised_text };
}

} // namespace vkpt::tests
