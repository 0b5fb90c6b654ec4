// SPDX-License-Identifier: GPL-2.0-or-later
// Tables and screen buffers, read as texels or by address, are the same tables.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>
#include <iterator>
#include <vector>

namespace vkpt::tests {
namespace {

// Walls with a picture, a fence with holes, a lamp that bounces meet, a moving light and all filters: together they
// read the tables and the screen buffers that can be texels.
formats::Image draw_room(const GameFolder& folder, const std::string& reads, const std::string& sampler)
{
    Session session(folder,
        { { "pt_table_reads", reads }, { "pt_light_sampler", sampler }, { "flt_denoiser", "asvgf" },
            { "flt_taa", "on" } },
        { 96, 64 });
    session.load_map("room");
    session.look({ -100, 0, 50 }, { 100, 20, 40 });
    engine::DynamicLight light {};
    light.color[0] = light.color[1] = 1;
    light.intensity = 150;
    session.view.dlight_count = 1;
    session.view.dlights = &light;
    for (int frame = 0; frame < 3; frame++) {
        light.origin[0] = float(frame * 10);
        light.origin[2] = 40;
        session.draw();
    }
    session.host().run_text("pt_info\n");
    if (session.has_line("llvmpipe") && reads != "auto") {
        EXPECT_TRUE(session.has_line("table reads    " + reads)); // GPUs read by address anyway
    }
    return session.capture_display();
}

TEST(TableReads, GiveTheSamePictureAsTexelsAndByAddress)
{
    GameFolder folder;
    folder.add_wall("wall", warm_index);
    folder.add_wall("lamp", white_index);
    folder.add_fence("fence", red_index);
    MapBuilder map;
    map.add_lit_room("wall");
    map.add(rectangle({ 20, 30, 40 }, { 40, 0, 0 }, { 0, 0, 40 }), map.add_material("fence", formats::SURF_ALPHATEST));
    folder.add_map("room", map.finish());
    // The way of reading outside: another one is another start of the module.
    constexpr const char* samplers[] = { "subset", "subset_mis_blue" };
    std::vector<formats::Image> texels;
    for (const char* sampler : samplers)
        texels.push_back(draw_room(folder, "texels", sampler));
    for (const char* reads : { "address", "auto" })
        for (size_t i = 0; i < std::size(samplers); i++)
            EXPECT_EQ(draw_room(folder, reads, samplers[i]).pixels, texels[i].pixels) << samplers[i] << ", " << reads;
}

} // namespace
} // namespace vkpt::tests
