// SPDX-License-Identifier: GPL-2.0-or-later
// Calls as bytes, both ways. A name is spelt out once in a chunk and a number from then on.
#pragma once

#include "common/trace/calls.hpp"
#include "common/trace/codec.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

namespace vkpt::trace {

class CallCodec {
public:
    template <class Coder> void code(Coder& coder, Call& call)
    {
        uint32_t kind = uint32_t(call.kind);
        coder.number(kind);
        if constexpr (!Coder::is_encoder) {
            if (kind >= uint32_t(CallKind::count))
                coder.fail("a call that does not exist");
            call = {};
            call.kind = CallKind(kind);
        }
        const CallForm& form = form_of(call.kind);
        if (form.name)
            code_name(coder, call.name);
        if (form.text)
            coder.text(call.text);
        if (form.flag) {
            uint32_t flag = call.flag;
            coder.number(flag);
            call.flag = flag != 0;
        }
        for (size_t i = 0; i < form.numbers; i++) {
            uint32_t number = uint32_t(call.numbers[i]);
            coder.near_number(number, 0);
            call.numbers[i] = int32_t(number);
        }
        for (size_t i = 0; i < form.reals; i++)
            coder.real(call.reals[i]);
        if (form.data)
            coder.data(call.data);
    }

private:
    template <class Coder> void code_name(Coder& coder, std::string& name)
    {
        uint32_t number = uint32_t(names_.size());
        if constexpr (Coder::is_encoder)
            if (const auto known = numbers_.find(name); known != numbers_.end())
                number = known->second;
        coder.number(number);
        coder.check(number <= names_.size(), "a name that was not defined");
        if (number < names_.size()) {
            name = names_[number];
            return;
        }
        coder.text(name);
        if constexpr (Coder::is_encoder)
            numbers_.emplace(name, number);
        names_.push_back(name);
    }

    std::vector<std::string> names_;
    std::map<std::string, uint32_t> numbers_;
};

} // namespace vkpt::trace
