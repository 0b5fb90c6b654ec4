// SPDX-License-Identifier: GPL-2.0-or-later
// The layer of faults (fault_layer.cpp) for modules that start in the test's own process.
#pragma once

#include "tests/fault_layer/fault_counts.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace vkpt::tests {

// Instances that are made while it lives have the layer.
class Faults {
public:
    // `text`: a fault a line; empty: none.
    explicit Faults(const std::string& text = "")
        : file_(std::filesystem::temp_directory_path() / ("vkpt_faults." + std::to_string(getpid())))
    {
        set(text);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_VKPT_faults", 1);
        setenv("VK_LAYER_PATH", VKPT_FAULT_LAYER ":/usr/share/vulkan/explicit_layer.d", 1);
        setenv("VKPT_FAULTS", file_.c_str(), 1);
    }
    Faults(const Faults&) = delete;
    Faults& operator=(const Faults&) = delete;
    ~Faults()
    {
        std::filesystem::remove(file_);
        for (const char* name : { "VK_INSTANCE_LAYERS", "VK_LAYER_PATH", "VKPT_FAULTS" })
            unsetenv(name);
    }

    void set(const std::string& text) const { std::ofstream(file_) << text << '\n'; }
    // While there is an instance.
    static FaultCounts counts()
    {
        FaultCounts counts;
        void* layer = dlopen(VKPT_FAULT_LAYER "/vkpt_fault_layer.so", RTLD_NOW | RTLD_NOLOAD);
        if (!layer) {
            ADD_FAILURE() << "the Vulkan loader did not take the layer of faults";
            return counts;
        }
        reinterpret_cast<GetFaultCounts>(dlsym(layer, "vkpt_fault_counts"))(&counts);
        dlclose(layer);
        return counts;
    }

private:
    std::filesystem::path file_;
};

} // namespace vkpt::tests
