// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/lavapipe.hpp"

#include <limits>

#ifdef __x86_64__
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <immintrin.h>
#endif

namespace vkpt {

#ifdef __x86_64__
namespace {

constexpr uint32_t entries = 1024, rounds = 64, lanes = 8; // a table of 16 kB, as large as the hot part of a tree

struct Table {
    alignas(64) std::array<uint64_t, entries * 2> words {};
    alignas(64) std::array<std::array<int32_t, lanes>, rounds> places {};
};

Table make_table()
{
    Table table;
    uint32_t random = 1;
    for (auto& row : table.places)
        for (int32_t& place : row) {
            random = random * 1664525u + 1013904223u;
            place = int32_t(random >> 22); // below `entries`
        }
    return table;
}

[[gnu::target("avx2")]] inline uint64_t total(const __m256i& sum)
{
    return uint64_t(_mm256_extract_epi64(sum, 0)) + uint64_t(_mm256_extract_epi64(sum, 1))
        + uint64_t(_mm256_extract_epi64(sum, 2)) + uint64_t(_mm256_extract_epi64(sum, 3));
}

// Both give the sum of all that they load, so that nothing of it is left out.
[[gnu::target("avx2"), gnu::noinline]] uint64_t sum_by_gathers(const Table& table)
{
    const auto* words = reinterpret_cast<const long long*>(table.words.data());
    __m256i sum = _mm256_setzero_si256();
    for (const auto& row : table.places) {
        const __m128i* half = reinterpret_cast<const __m128i*>(row.data());
        for (int i = 0; i < 2; i++) {
            const __m128i first = _mm_slli_epi32(_mm_load_si128(half + i), 1);
            sum = _mm256_add_epi64(sum, _mm256_i32gather_epi64(words, first, 8));
            sum = _mm256_add_epi64(sum, _mm256_i32gather_epi64(words + 1, first, 8));
        }
    }
    return total(sum);
}

[[gnu::target("avx2"), gnu::noinline]] uint64_t sum_lane_by_lane(const Table& table)
{
    const auto* texels = reinterpret_cast<const __m128i*>(table.words.data());
    __m256i sum = _mm256_setzero_si256();
    for (const auto& row : table.places)
        for (uint32_t lane = 0; lane < lanes; lane += 4) {
            const __m256i a = _mm256_inserti128_si256(
                _mm256_castsi128_si256(_mm_load_si128(texels + row[lane])), _mm_load_si128(texels + row[lane + 2]), 1);
            const __m256i b = _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_load_si128(texels + row[lane + 1])),
                _mm_load_si128(texels + row[lane + 3]), 1);
            sum = _mm256_add_epi64(sum, _mm256_unpacklo_epi64(a, b));
            sum = _mm256_add_epi64(sum, _mm256_unpackhi_epi64(a, b));
        }
    return total(sum);
}

// Nanoseconds, the least of many: whatever else the machine does only adds to it.
template <typename Work> double min_time(Work work)
{
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i < 40; i++) {
        const auto start = std::chrono::steady_clock::now();
        [[maybe_unused]] volatile uint64_t used = work();
        const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
        least = std::min(least, taken.count());
    }
    return least;
}

} // namespace

double measure_gathers()
{
    if (!__builtin_cpu_supports("avx2"))
        return std::numeric_limits<double>::infinity();
    const Table table = make_table();
    const double gathers = min_time([&] { return sum_by_gathers(table); });
    return gathers / min_time([&] { return sum_lane_by_lane(table); });
}
#else
double measure_gathers() { return std::numeric_limits<double>::infinity(); }
#endif

} // namespace vkpt
