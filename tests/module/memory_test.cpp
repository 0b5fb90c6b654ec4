// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures do not depend on what device memory held before.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace vkpt::tests {
namespace {

class FilledMemory : public testing::Test {
protected:
    FilledMemory()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("glass", 100);
        MapBuilder map;
        // A floor, two walls and a pane; elsewhere there is nothing but sky.
        const uint16_t wall = map.add_material("wall");
        map.add(rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), wall);
        map.add(rectangle({ 120, 0, 60 }, { 0, -80, 0 }, { 0, 0, 60 }), wall);
        map.add(
            rectangle({ 60, 30, 40 }, { 0, -30, 0 }, { 0, 0, 30 }), map.add_material("glass", formats::SURF_TRANS33));
        map.add(rectangle({ 119, 40, 80 }, { 0, -20, 0 }, { 0, 0, 20 }), map.add_material("lamp", 0, 500));
        for (int i = 0; i < 6; i++)
            map.add_point_light({ -50 + 20 * float(i), -60, 100 }, 150);
        folder_.add_map("room", map.finish());
        cube_path_ = folder_.add_cube("cube", 10, red_index);
    }
    ~FilledMemory() override { unsetenv("VKPT_FILL_MEMORY"); }

    // A journey in which lights and things come and go, the size changes and the map starts anew.
    std::vector<Radiance> draw_all(const CvarList& cvars, const char* fill)
    {
        setenv("VKPT_FILL_MEMORY", fill, 1);
        CvarList all { { "pt_seed", "0" }, { "pt_exposure", "2" } };
        all.insert(all.end(), cvars.begin(), cvars.end());
        Session::end_idle();
        Session session(folder_, all, { 80, 60 });
        const engine::DynamicLight light { { 20, 0, 40 }, { 1, 0.7f, 0.4f }, 300 };
        session.view.dlights = &light;
        std::vector<Radiance> pictures;
        for (int round = 0; round < 2; round++) {
            session.load_map("room");
            engine::Entity cube = make_entity(session.module().register_model(cube_path_.c_str()), { 30, -20, 20 });
            for (int frame = 0; frame < 12; frame++) {
                session.look({ -90, 3 * float(frame), 70 }, { 60, 10, 50 });
                session.view.time = 1 + 0.05f * float(frame);
                session.view.dlight_count = frame % 4 < 2;
                session.view.entities = &cube;
                session.view.entity_count = frame % 5 != 4;
                session.set("pt_render_scale", frame >= 6 ? 60 : 100);
                session.draw();
                if (frame % 3 == 2)
                    pictures.push_back(session.capture());
            }
        }
        return pictures;
    }

    void expect_independence(const CvarList& cvars)
    {
        const std::vector<Radiance> zeros = draw_all(cvars, "0");
        for (const char* fill : { "63", "85", "255" }) { // floats around 0.75 and 1e13, and NaN
            const std::vector<Radiance> filled = draw_all(cvars, fill);
            ASSERT_EQ(filled.size(), zeros.size());
            for (size_t i = 0; i < zeros.size(); i++) {
                EXPECT_EQ(count_broken(filled[i]), 0u) << fill << ", picture " << i;
                EXPECT_TRUE(filled[i] == zeros[i]) << fill << ", picture " << i;
            }
        }
    }

    GameFolder folder_;
    std::string cube_path_;
};

TEST_F(FilledMemory, DoesNotShowInFilteredPictures)
{
    expect_independence({ { "flt_denoiser", "asvgf" }, { "flt_taa", "upscale" } });
}

TEST_F(FilledMemory, DoesNotShowWithSharedBouncesAndMis)
{
    expect_independence(
        { { "flt_denoiser", "asvgf" }, { "pt_light_sampler", "subset_mis_blue" }, { "pt_bounce_pixels", "quarter" } });
}

TEST_F(FilledMemory, DoesNotShowInUnfilteredPictures) { expect_independence({ { "pt_bounces", "2" } }); }

TEST_F(FilledMemory, DoesNotShowThroughTheDevicesOwnRays)
{
    expect_independence({ { "pt_trace", "query" }, { "flt_denoiser", "temporal" } });
}

constexpr const char* heaps_used = "heaps (MiB)";

// Module and test share a C library.
TEST(HeapMemory, IsToldOfWhatIsUsedAndNotOfWhatIsFree)
{
    GameFolder folder;
    Session session(folder);
    const double before = session.info_number(heaps_used);
    ASSERT_GT(before, 1) << "pt_info told nothing of the heaps";
    constexpr size_t small = 1 << 10, large = 1 << 20; // large ones lie outside of the heaps
    std::vector<std::vector<char>> blocks(32 << 10, std::vector<char>(small, 1));
    for (int i = 0; i < 32; i++)
        blocks.emplace_back(large, 1);
    EXPECT_NEAR(session.info_number(heaps_used), before + 64, 4);
    blocks = {};
    EXPECT_NEAR(session.info_number(heaps_used), before, 4);
}

} // namespace
} // namespace vkpt::tests
