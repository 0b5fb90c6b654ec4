// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/free_memory.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vkpt {

void give_back_free_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void FreeMemory::end_frame(const Loaded& loaded, Clock::time_point now)
{
    if (loaded != loaded_) {
        loaded_ = loaded;
        loaded_at_ = now;
        frames_ = 0;
        is_due_ = true;
    }
    if (!is_due_ || ++frames_ <= delay_frames || now - loaded_at_ < delay)
        return;
    is_due_ = false;
    giving_back_ = std::async(std::launch::async, give_back_free_memory); // tens of milliseconds
}

} // namespace vkpt
