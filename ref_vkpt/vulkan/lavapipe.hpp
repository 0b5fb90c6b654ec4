// SPDX-License-Identifier: GPL-2.0-or-later
// What Mesa's CPU driver (lavapipe) wants differently from the drivers of GPUs.
#pragma once

#include "ref_vkpt/vulkan/device_traits.hpp"
#include "ref_vkpt/vulkan/functions.hpp"

#include <optional>
#include <string>

namespace vkpt {

// How shaders read tables and screen buffers, in the order of pt_table_reads. GPUs read by address, whatever is asked
// for.
enum class TableReads { automatic, texels, address };

// Sets an environment variable unless the user did, until the end of life.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const std::string& value);
    ~ScopedVariable();
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* name_; // null: the user's value stays
};

// The driver runs our compute BVH up to twice as fast with 512-bit vectors, and its disk cache ignores the width: code
// of one width, found by a program that runs with another, crashes it. So the width is changed only together with a
// cache of our own. The driver reads the width again and again, so both stay as long as the device. Then they go:
// Mesa's OpenGL, which an engine that goes on with another renderer loads into the same process, cannot draw with such
// vectors.
class CpuDriverSettings {
public:
    // An empty folder, or a cache chosen by the user: nothing is changed.
    explicit CpuDriverSettings(const std::string& cache_directory);

    const std::string& directory() const { return directory_; }

private:
    std::string directory_; // empty: not ours
    std::optional<ScopedVariable> width_, cache_;
};

// Throws FatalError: with as little address space as `ulimit -v` leaves the driver's compiler would crash.
void check_address_space();

// What device X does differently; the values of DeviceTraits' declaration for a GPU.
DeviceTraits find_traits(const VkPhysicalDeviceProperties& properties);

// Whether shaders read as texels (lib/device/texels.glsl). CPU drivers load a texel lane by lane, and make gathers of
// what is read by address: which is quicker is the processor's matter (docs/notes/cpu-driver.md), and measured where
// `wanted` is automatic.
bool choose_texels(const VkPhysicalDeviceProperties& properties, TableReads wanted);

} // namespace vkpt
