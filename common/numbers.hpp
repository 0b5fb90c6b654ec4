// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers in text.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace vkpt {

// The finite number that the text begins with, which is cut off; none: it begins with something else.
template <class Number> std::optional<Number> take_number(std::string_view& text)
{
    Number number {};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc())
        return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>)
        if (!std::isfinite(number))
            return std::nullopt;
    text.remove_prefix(size_t(end - text.data()));
    return number;
}

// The finite number that is the whole text.
template <class Number> std::optional<Number> parse_number(std::string_view text)
{
    const std::optional<Number> number = take_number<Number>(text);
    return text.empty() ? number : std::nullopt;
}

// `count` numbers with blanks between them, and around all.
template <class Number, size_t count> std::optional<std::array<Number, count>> parse_numbers(std::string_view text)
{
    const auto skip_blanks = [&] {
        const size_t blanks = text.find_first_not_of(" \t");
        text.remove_prefix(blanks == std::string_view::npos ? text.size() : blanks);
        return blanks > 0;
    };
    std::array<Number, count> numbers {};
    skip_blanks();
    for (size_t i = 0; i < count; i++) {
        const std::optional<Number> number = take_number<Number>(text);
        if (!number)
            return std::nullopt;
        numbers[i] = *number;
        if (!skip_blanks() && !text.empty())
            return std::nullopt;
    }
    return text.empty() ? std::optional(numbers) : std::nullopt;
}

} // namespace vkpt
