// SPDX-License-Identifier: GPL-2.0-or-later
// An engine for tests: keeps what a refresh module does to it. Errors leave by longjmp, as the engine's do.
#pragma once

#include "ref_vkpt/engine/contract.hpp"

#include <csetjmp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkpt::tests {

struct MockEngine {
    struct Variable {
        std::string name, text;
        engine::Cvar cvar {};
    };

    explicit MockEngine(const std::string& version = "8.20 x86_64");
    ~MockEngine();
    MockEngine(const MockEngine&) = delete;
    MockEngine& operator=(const MockEngine&) = delete;

    engine::Imports imports() const;
    void set(const std::string& name, const std::string& text);
    std::string get(const std::string& name) const;
    // Console lines that contain `part`.
    std::vector<std::string> lines_with(const std::string& part) const;

    // The exact bits that functions returning the engine's qboolean give.
    engine::QBoolean truth = 1, falsehood = 0;
    bool window_works = true;
    // Called inside init_graphics, as the engine calls PrepareForWindow and InitContext.
    std::function<bool()> make_window;

    std::map<std::string, Variable> variables;
    std::map<std::string, int> cvar_flags;
    std::map<std::string, void (*)()> commands;
    std::vector<std::string> arguments;
    std::map<std::string, std::string> files;
    int restart = 0; // as last requested
    std::map<std::string, int> told_sizes; // of files, where their directory tells another size
    int files_loaded = 0, files_out = 0; // all, and those not given back
    std::vector<std::string> console;
};

// What the module raised with Imports::error while `call` ran.
struct RaisedError {
    int level;
    std::string text;
};
std::optional<RaisedError> catch_error(void (*call)(void* argument), void* argument);

template <class Call> std::optional<RaisedError> catch_error(Call call)
{
    return catch_error([](void* argument) { (*static_cast<Call*>(argument))(); }, &call);
}

} // namespace vkpt::tests
