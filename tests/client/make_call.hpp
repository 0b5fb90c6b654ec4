// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "common/trace/calls.hpp"

#include <string>

namespace vkpt::tests {

inline trace::Call make_call(trace::CallKind kind, const std::string& name = "", int32_t number = 0)
{
    trace::Call call;
    call.kind = kind;
    call.name = name;
    call.numbers[0] = number;
    return call;
}

} // namespace vkpt::tests
