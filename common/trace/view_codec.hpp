// SPDX-License-Identifier: GPL-2.0-or-later
// Views as differences to the views before them. What moves is interpolated by the engine's client, so that a float's
// bits, taken as a whole number, go on evenly for many frames: each word is guessed from its own last four values, and
// the error of the guess is what is written.
#pragma once

#include "common/trace/calls.hpp"
#include "common/trace/codec.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vkpt::trace {

// One 32-bit word over time, newest first.
class WordHistory {
public:
    uint32_t guess() const;
    void push(uint32_t value)
    {
        values_ = { value, values_[0], values_[1], values_[2] };
        count_ += count_ < 4;
    }

private:
    std::array<uint32_t, 4> values_ {};
    uint8_t count_ = 0;
};

template <size_t count> using RecordHistory = std::array<WordHistory, count>;

// Both ends keep one, and start anew at the same places.
class ViewCodec {
public:
    // Coder: Encoder, which reads `view`, or Decoder, which fills it.
    template <class Coder> void code(Coder& coder, View& view);

private:
    static constexpr size_t head_words = 18, entity_words = 18, light_words = 7, particle_words = 5;
    template <size_t count> struct Known {
        std::array<uint32_t, count> words {};
        RecordHistory<count> history;
    };
    template <size_t count> using List = std::vector<Known<count>>;

    template <class Coder, size_t count, class Match>
    void code_list(Coder& coder, std::vector<std::array<uint32_t, count>>& items, List<count>& last, Match find_last);
    template <class Coder> void code_lightstyles(Coder& coder, View& view);
    template <class Coder> void code_area_bits(Coder& coder, View& view);

    RecordHistory<head_words> head_;
    List<entity_words> entities_;
    List<light_words> lights_;
    List<particle_words> particles_;
    std::array<engine::Lightstyle, engine::max_lightstyles> lightstyles_ {};
    std::array<uint8_t, max_area_bytes> area_bits_ {};
};

extern template void ViewCodec::code(Encoder&, View&);
extern template void ViewCodec::code(Decoder&, View&);

} // namespace vkpt::trace
