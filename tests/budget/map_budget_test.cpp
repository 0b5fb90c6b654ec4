// SPDX-License-Identifier: GPL-2.0-or-later
// No map of less than a megabyte takes more than 512 MB or 5 seconds of a processor, from its bytes to all that is made of
// it at load: each is loaded in a process of its own, which is measured from outside.
#include "ref_vkpt/lights/light_multisets.hpp"
#include "ref_vkpt/lights/light_trees.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "tests/budget/hostile_maps.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define VKPT_IS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VKPT_IS_SANITIZED 1
#endif
#endif
#ifndef VKPT_IS_SANITIZED
#define VKPT_IS_SANITIZED 0
#endif

namespace vkpt::test {
namespace {

constexpr double most_megabytes = 512, most_seconds = 5;

// A picture with as many lamps in it as one can have.
WorldPicture make_picture()
{
    WorldPicture picture;
    for (const float x : { 0.1f, 0.6f })
        for (const float y : { 0.2f, 0.7f })
            picture.parts.push_back({ { x, y }, { x + 0.2f, y + 0.2f }, glm::vec3(0.9f, 0.8f, x) });
    return picture;
}

// What the module makes of a map at load; what it says where it refuses it.
std::string use_map(const std::vector<std::byte>& file)
{
    try {
        const auto world = load_world(
            file, "maps/bad.bsp", [](const std::string&) { return make_picture(); }, {});
        world->bvh();
        world->make_materials(1, {});
        make_light_multisets(world->bsp, world->light_lists, world->models[0].emitters);
        make_light_trees(world->light_lists.lists(), world->light_lists.static_indices(), world->models[0].emitters);
        return "";
    } catch (const formats::FormatError& error) {
        return error.what();
    }
}

struct Cost {
    int status = 0; // of wait()
    std::string refusal;
    double seconds = 0, megabytes = 0;
};

// In a process of its own.
Cost measure(const std::vector<std::byte>& file)
{
    std::array<int, 2> ends {};
    Cost cost;
    if (pipe(ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t child = fork();
    if (child == 0) {
        const rlimit seconds { 30, 30 }, bytes { rlim_t(6) << 30, rlim_t(6) << 30 }; // does not take the machine along
        setrlimit(RLIMIT_CPU, &seconds);
        if (!VKPT_IS_SANITIZED) // which reserve all memory
            setrlimit(RLIMIT_AS, &bytes);
        const std::string refusal = use_map(file);
        const bool written = write(ends[1], refusal.data(), refusal.size()) == ssize_t(refusal.size());
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    std::array<char, 4096> text {};
    for (ssize_t count; (count = read(ends[0], text.data(), text.size())) > 0;)
        cost.refusal.append(text.data(), size_t(count));
    close(ends[0]);
    rusage usage {};
    wait4(child, &cost.status, 0, &usage);
    const auto to_seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    cost.seconds = to_seconds(usage.ru_utime) + to_seconds(usage.ru_stime);
    cost.megabytes = double(usage.ru_maxrss) / 1024;
    return cost;
}

void expect_within_budget(const std::string& name, const std::vector<std::byte>& file, Cost& cost)
{
    ASSERT_LT(file.size(), 1'000'000u) << name;
    cost = measure(file);
    std::printf("%-38s %7zu bytes: %5.2f s, %4.0f MB %s\n", name.c_str(), file.size(), cost.seconds, cost.megabytes,
        cost.refusal.c_str());
    EXPECT_TRUE(WIFEXITED(cost.status) && WEXITSTATUS(cost.status) == 0) << name << ": status " << cost.status;
    if (!VKPT_IS_SANITIZED) {
        EXPECT_LE(cost.seconds, most_seconds) << name;
        EXPECT_LE(cost.megabytes, most_megabytes) << name;
    }
    if (!cost.refusal.empty()) {
        EXPECT_NE(cost.refusal.find("maps/bad.bsp"), std::string::npos) << cost.refusal;
    }
}

TEST(MapBudget, HostileMapsAreCheapOrRefused)
{
    for (const HostileMap& map : make_hostile_maps()) {
        Cost cost;
        expect_within_budget(map.name, map.file, cost);
        EXPECT_EQ(!cost.refusal.empty(), map.is_refused) << map.name << ": " << cost.refusal;
    }
}

TEST(MapBudget, CollectedFilesAreCheapOrRefused)
{
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(VKPT_BAD_FILES)) {
        if (entry.path().extension() != ".bsp")
            continue;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::vector<char> bytes { std::istreambuf_iterator<char>(stream), {} };
        const auto* const first = reinterpret_cast<const std::byte*>(bytes.data());
        Cost cost;
        expect_within_budget(entry.path().filename().string(), { first, first + bytes.size() }, cost);
        count++;
    }
    EXPECT_GE(count, 3u);
}

} // namespace
} // namespace vkpt::test
