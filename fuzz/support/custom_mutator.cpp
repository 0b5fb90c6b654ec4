// SPDX-License-Identifier: GPL-2.0-or-later
// libFuzzer's hook for the mutator VKPT_MUTATOR, a function of mutate.hpp.
#include "fuzz/support/mutate.hpp"

#include <algorithm>

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned int seed)
{
    using namespace vkpt::fuzz;
    Random random(seed);
    const File file = VKPT_MUTATOR(File(data, data + size), most, random);
    std::copy_n(file.begin(), std::min(file.size(), most), data);
    return std::min(file.size(), most);
}
