// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/lavapipe.hpp"

#include "ref_vkpt/engine/errors.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <sys/resource.h>

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

// How long gather instructions take for a table's entries of 16 bytes, by the time of loading the same lane by
// lane: 1.1 to 1.8 on a Sapphire Rapids, 2.7 on an EPYC, where neither is faster. The 9 ns that a gather takes where
// microcode guards it against data sampling (docs/notes/cpu-driver.md) would come to 8 or more. Infinite where there
// are none. Takes 0.1 ms.
double measure_gathers()
{
    if (!__builtin_cpu_supports("avx2"))
        return std::numeric_limits<double>::infinity();
    const Table table = make_table();
    const double gathers = min_time([&] { return sum_by_gathers(table); });
    return gathers / min_time([&] { return sum_lane_by_lane(table); });
}

} // namespace
#else
static double measure_gathers() { return std::numeric_limits<double>::infinity(); }
#endif

static bool is_cpu(const VkPhysicalDeviceProperties& properties)
{
    return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

ScopedVariable::ScopedVariable(const char* name, const std::string& value)
    : name_(std::getenv(name) ? nullptr : name)
{
    if (name_)
        setenv(name_, value.c_str(), 1);
}

ScopedVariable::~ScopedVariable()
{
    if (name_)
        unsetenv(name_);
}

CpuDriverSettings::CpuDriverSettings(const std::string& cache_directory)
{
    if (cache_directory.empty() || std::getenv("MESA_SHADER_CACHE_DIR"))
        return;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw"))
        width_.emplace("LP_NATIVE_VECTOR_WIDTH", "512");
#endif
    const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
    directory_ = fmt::format("{}/driver-{}", cache_directory, width ? width : "default");
    cache_.emplace("MESA_SHADER_CACHE_DIR", directory_);
}

void check_address_space()
{
    constexpr rlim_t min_bytes = rlim_t(2) << 30;
    rlimit limit {};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < min_bytes)
        throw FatalError(
            fmt::format("this process may take {} MiB of address space, and Vulkan drivers need {}: lift the "
                        "limit with \"ulimit -v unlimited\" and start again",
                limit.rlim_cur >> 20, min_bytes >> 20));
}

DeviceTraits find_traits(const VkPhysicalDeviceProperties& properties)
{
    if (!is_cpu(properties))
        return {};
    return { .max_texture_taps = 4,
        .bounce_block_rows = 2,
        .sorts_triangles = true,
        .measures_traces = false,
        .trace_measurements = 1, // they take seconds
        .traces_in_parallel = false,
        .has_distant_clock = false,
        .can_be_lost = false,
        .specializes_pipelines = false,
        .gpu_lanes = false,
        .keeps_compiled_shaders = true };
}

bool choose_texels(const VkPhysicalDeviceProperties& properties, TableReads wanted)
{
    constexpr uint32_t min_texels = 1u << 27; // tables may grow to so many
    constexpr double slow_gathers = 4;
    if (!is_cpu(properties) || properties.limits.maxTexelBufferElements < min_texels)
        return false;
    return wanted == TableReads::automatic ? measure_gathers() > slow_gathers : wanted == TableReads::texels;
}

} // namespace vkpt
