// SPDX-License-Identifier: GPL-2.0-or-later
// No map of less than a megabyte takes more than the budget of tests/formats/file_budget.hpp, from its bytes to all
// that is made of it at load.
#include "ref_vkpt/lights/sampler_tables.hpp"
#include "ref_vkpt/scene/lightmaps.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "tests/budget/hostile_maps.hpp"
#include "tests/formats/file_budget.hpp"

#include <cstdio>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// A texture with as many lamps in it as one can have.
FaceTexture make_texture()
{
    FaceTexture texture;
    for (const float x : { 0.1f, 0.6f })
        for (const float y : { 0.2f, 0.7f })
            texture.parts.push_back({ { x, y }, { x + 0.2f, y + 0.2f }, glm::vec3(0.9f, 0.8f, x) });
    return texture;
}

// What the module makes of a map at load.
void use_map(const std::vector<std::byte>& file)
{
    const auto find_texture = [](const std::string&) { return make_texture(); };
    const auto world = load_world(file, "maps/bad.bsp", find_texture, {});
    world->trees();
    world->make_materials(1, {});
    read_lightmaps(*world);
    const LightLists& lists = world->light_lists;
    make_sampler_tables(
        { lists.lists(), lists.static_indices(), world->models[0].emitters, &world->bsp, &lists, &world->faces },
        shared::SAMPLER_NEEDS);
}

Cost expect_cheap(const std::string& name, const std::vector<std::byte>& file)
{
    EXPECT_LT(file.size(), small_file_bytes) << name;
    Cost cost = expect_within_budget(name, [&] { use_map(file); });
    std::printf("%-38s %6zu bytes: %5.2f s, %4zu MB, %s\n", name.c_str(), file.size(), cost.cpu_seconds,
        cost.peak_bytes >> 20, cost.outcome.c_str());
    if (cost.refused()) { // it names the file
        EXPECT_NE(cost.outcome.find("maps/bad.bsp"), std::string::npos) << cost.outcome;
    }
    return cost;
}

TEST(MapBudget, HostileMapsAreCheapOrRefused)
{
    for (const test::HostileMap& map : test::make_hostile_maps())
        EXPECT_EQ(expect_cheap(map.name, map.file).refused(), map.is_refused) << map.name;
}

TEST(MapBudget, CollectedMapsAreCheapOrRefused)
{
    for (const std::filesystem::path& path : files_in(VKPT_BAD_FILES, ".bsp"))
        expect_cheap(path.filename().string(), file_bytes(path));
}

} // namespace
} // namespace vkpt::tests
