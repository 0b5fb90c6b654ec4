// SPDX-License-Identifier: GPL-2.0-or-later
// Tables and screen buffers, read as texels or by address, are the same tables.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// Textured walls, a lamp that bounces meet, a moving light, all filters: every table and every screen buffer is read.
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
    return session.capture_display();
}

TEST(TableReads, GiveTheSamePictureAsTexelsAndByAddress)
{
    GameFolder folder;
    folder.add_wall("lamp", white_index);
    MapBuilder map;
    map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("missing"));
    map.add(rectangle({ 0, 0, 127 }, { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("lamp", 0, 1000));
    folder.add_map("room", map.finish());
    for (const char* sampler : { "subset", "subset_mis_blue" }) {
        const formats::Image texels = draw_room(folder, "texels", sampler),
                             address = draw_room(folder, "address", sampler);
        EXPECT_EQ(texels.pixels, address.pixels) << sampler;
        EXPECT_EQ(address.pixels, draw_room(folder, "auto", sampler).pixels) << sampler;
    }
}

} // namespace
} // namespace vkpt::tests
