// SPDX-License-Identifier: GPL-2.0-or-later
// Maps that were not made for these tests: those in the folder $VKPT_TEST_MAPS, all their pictures missing, and our own
// level with its data where the build has made it.
#include "client/host/client_map.hpp"
#include "formats/entities.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

constexpr size_t max_views = 4;
constexpr int frames = 8;

// The eyes of players at up to `max_views` start points, spread over the map.
std::vector<client::Camera> find_starts(const formats::Bsp& bsp)
{
    std::vector<client::Camera> starts;
    for (const formats::EntityText& entity : formats::parse_entities(bsp.entity_text, bsp.name))
        if (entity.class_name().starts_with("info_player_"))
            if (const auto start = client::find_player_start({ entity }))
                starts.push_back(*start);
    std::vector<client::Camera> chosen;
    for (size_t i = 0; i < std::min(max_views, starts.size()); i++)
        chosen.push_back(starts[i * starts.size() / std::min(max_views, starts.size())]);
    return chosen;
}

// Every start's picture is whole and lit.
void expect_lit(Session& session, const std::string& map)
{
    const auto bytes = session.files().read(map);
    ASSERT_TRUE(bytes) << map;
    const std::vector<client::Camera> starts = find_starts(formats::read_bsp(*bytes, map));
    ASSERT_FALSE(starts.empty()) << map;
    client::ClientMap scene(session.files(), client::parse_scene_name(map));
    scene.register_with(session.host());
    for (const client::Camera& start : starts) {
        scene.set_camera(start);
        SCOPED_TRACE(fmt::format("{} from {} {} {}", map, start.position.x, start.position.y, start.position.z));
        for (int frame = 0; frame < frames; frame++)
            session.host().draw_frame(scene.view(session.view.width, session.view.height, 0));
        const Radiance picture = session.capture();
        EXPECT_EQ(count_broken(picture), 0u);
        EXPECT_GT(luminance(picture.mean()), 0.005f);
        const size_t lit = size_t(
            std::ranges::count_if(picture.pixels, [](const glm::vec3& pixel) { return luminance(pixel) > 0; }));
        EXPECT_GT(lit, picture.pixels.size() / 2);
    }
}

std::vector<fs::path> test_maps()
{
    std::vector<fs::path> maps;
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (folder && *folder)
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".bsp")
                maps.push_back(entry.path());
    std::ranges::sort(maps);
    return maps;
}

TEST(RealMaps, AreLitWithEveryPictureMissing)
{
    const std::vector<fs::path> maps = test_maps();
    if (maps.empty())
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with maps";
    const GameFolder folder;
    Session session(folder, { { "pt_accumulate", "1" } });
    for (const fs::path& map : maps) {
        const std::string name = "maps/" + map.filename().string();
        session.files().add_file(name, map);
        expect_lit(session, name);
        EXPECT_TRUE(session.has_line("shown grey")) << name;
    }
}

TEST(RealMaps, OurLevelIsLit)
{
    if (!fs::exists(fs::path(VKPT_GAME_FOLDER) / "baseq2/maps/vkpt1.bsp"))
        FAIL() << "the build has made no game data: build the target game_data";
    Session session(fs::path(VKPT_GAME_FOLDER), { { "pt_accumulate", "1" } });
    expect_lit(session, "maps/vkpt1.bsp");
    EXPECT_FALSE(session.has_line("shown grey"));
}

} // namespace
} // namespace vkpt::tests
