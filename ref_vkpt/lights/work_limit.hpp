// SPDX-License-Identifier: GPL-2.0-or-later
// How much a map's file may ask for. How often loops run is for its author to say, and by accident or on purpose a
// small file can ask for hours and gigabytes: all that may grow faster than the file is counted here, and refused
// beyond what ten times the busiest map needs.
#pragma once

#include "formats/bsp.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace vkpt {

class WorkLimit {
public:
    // `what`, plural, is what is counted: "light list entries". Larger files may have more, and what was made in memory
    // any number.
    WorkLimit(const formats::Bsp& bsp, uint64_t per_megabyte, std::string_view what)
        : file_(bsp.name)
        , what_(what)
        , max_(bsp.file_size == 0 ? UINT64_MAX
                                  : uint64_t(double(per_megabyte) * std::max(double(bsp.file_size) / 1e6, 1.0)))
    {
    }

    // Throws formats::FormatError once there have been too many; `place` names what of the map is to blame: "face", 12.
    void spend(uint64_t count, std::string_view place, size_t index)
    {
        spent_ += count;
        if (spent_ > max_)
            throw formats::FormatError(file_, 0,
                std::string(place) + " " + std::to_string(index) + ": with it the map needs more than "
                    + std::to_string(max_) + " " + what_ + ", far more than a map of this size may");
    }
    uint64_t spent() const { return spent_; }

private:
    std::string file_, what_;
    uint64_t max_, spent_ = 0;
};

} // namespace vkpt
