// SPDX-License-Identifier: GPL-2.0-or-later
// How renderer code fails. It throws; engine/exports.cpp alone turns what it catches into the engine's own errors.
#pragma once

#include <stdexcept>

namespace vkpt {

// This level cannot go on, the game can: the engine returns to its console with the text.
// The device's memory may run out for a level, too. Say what, where, why and what to do. formats::FormatError and
// std::bad_alloc are treated the same way.
class LevelError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The module cannot go on (a Vulkan call failed, the device is lost). During Init: one console line, and the engine
// falls back to its own renderers. Later: the engine stops with the text.
class FatalError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The device was lost: everything on it has gone, another device may serve. The engine is asked to start the renderer
// anew, once; after that it stops with the text.
class DeviceLost : public FatalError {
public:
    using FatalError::FatalError;
};

} // namespace vkpt
