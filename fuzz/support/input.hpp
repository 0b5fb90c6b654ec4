// SPDX-License-Identifier: GPL-2.0-or-later
// Takes an input apart for harnesses whose subject is no file: numbers and records from its front. Past the end: zeros.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace vkpt::fuzz {

class Input {
public:
    Input(const uint8_t* data, size_t size)
        : data_(data)
        , size_(size)
    {
    }

    bool is_empty() const { return size_ == 0; }

    template <class T> T take()
    {
        T value {};
        const size_t count = std::min(sizeof(T), size_);
        if (count > 0)
            std::memcpy(&value, data_, count);
        skip(count);
        return value;
    }

    // Up to `end`, which is skipped.
    std::string_view take_until(char end)
    {
        const std::string_view rest(reinterpret_cast<const char*>(data_), size_);
        const std::string_view text = rest.substr(0, rest.find(end));
        skip(std::min(text.size() + 1, size_));
        return text;
    }

private:
    void skip(size_t count)
    {
        data_ += count;
        size_ -= count;
    }

    const uint8_t* data_;
    size_t size_;
};

} // namespace vkpt::fuzz
