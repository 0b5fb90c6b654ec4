// SPDX-License-Identifier: GPL-2.0-or-later
// Which liquid a face bounds, and on which side of it that is.
#include "ref_vkpt/lights/media.hpp"
#include "tests/lights/synthetic_bsp.hpp"

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

using namespace shared;

// Two leaves: what lies below z = 0, and air above. One face at z = 0 that looks up, and one that looks down.
formats::Bsp make_pool(uint32_t contents, uint32_t above = 0)
{
    formats::Bsp bsp;
    bsp.planes.push_back({ glm::vec3(0, 0, 1), 0, 2 });
    formats::BspNode node {};
    node.children[0] = -1;
    node.children[1] = -2;
    bsp.nodes.push_back(node);
    bsp.leaves.resize(2);
    bsp.leaves[0].contents = above;
    bsp.leaves[1].contents = contents;
    bsp.leaves[1].mins[0] = bsp.leaves[1].mins[1] = bsp.leaves[1].mins[2] = -64;
    bsp.leaves[1].maxs[0] = bsp.leaves[1].maxs[1] = 64;
    bsp.edges.push_back({});
    formats::BspTexinfo texinfo {};
    texinfo.flags = formats::SURF_WARP | formats::SURF_TRANS66;
    texinfo.texture = "liquid";
    texinfo.next = -1;
    bsp.texinfos.push_back(texinfo);
    const std::vector<glm::vec3> up { { -64, -64, 0 }, { 64, -64, 0 }, { 64, 64, 0 }, { -64, 64, 0 } };
    add_face(bsp, up, { 0, 0, 1 }, 0);
    add_face(bsp, { up.rbegin(), up.rend() }, { 0, 0, -1 }, 0);
    bsp.models.push_back({ glm::vec3(-64), glm::vec3(64), glm::vec3(0), 0, 0, 2 });
    return bsp;
}

TEST(Media, AreTheLeavesContents)
{
    const std::pair<uint32_t, uint32_t> kinds[] = { { formats::CONTENTS_WATER, MEDIUM_WATER },
        { formats::CONTENTS_SLIME, MEDIUM_SLIME }, { formats::CONTENTS_LAVA, MEDIUM_LAVA } };
    for (const auto& [contents, medium] : kinds) {
        const formats::Bsp bsp = make_pool(contents);
        EXPECT_EQ(medium_of_face(bsp, 0, 0), medium);
        EXPECT_EQ(medium_of_face(bsp, 1, 0), medium | MEDIUM_IN_FRONT);
        EXPECT_EQ(find_texinfo_media(bsp), std::vector<uint32_t> { medium });
    }
    // A liquid's lower side.
    const formats::Bsp hanging = make_pool(0, formats::CONTENTS_WATER);
    EXPECT_EQ(medium_of_face(hanging, 0, 0), MEDIUM_WATER | MEDIUM_IN_FRONT);
    EXPECT_EQ(medium_of_face(hanging, 1, 0), MEDIUM_WATER);
}

TEST(Media, NamesCountWhereLeavesTellNothing)
{
    formats::Bsp bsp = make_pool(0);
    EXPECT_EQ(medium_of_face(bsp, 0, 0), MEDIUM_WATER);
    bsp.texinfos[0].texture = "e1u3/BrLava";
    EXPECT_EQ(medium_of_face(bsp, 0, 0), MEDIUM_LAVA);
    bsp.texinfos[0].texture = "e1u3/slime1";
    EXPECT_EQ(medium_of_face(bsp, 1, 0), MEDIUM_SLIME | MEDIUM_IN_FRONT);
    bsp.texinfos[0].flags = formats::SURF_TRANS66;
    EXPECT_EQ(medium_of_face(bsp, 0, 0), MEDIUM_NONE) << "glass";
}

TEST(Media, MaterialsGoBeforeLeavesAndNames)
{
    for (const uint32_t contents : { uint32_t(formats::CONTENTS_WATER), 0u }) {
        const formats::Bsp bsp = make_pool(contents);
        EXPECT_EQ(medium_of_face(bsp, 0, 0, MEDIUM_SLIME), MEDIUM_SLIME);
        EXPECT_EQ(medium_of_face(bsp, 1, 0, MEDIUM_SLIME), MEDIUM_SLIME | MEDIUM_IN_FRONT);
        FaceTexture texture;
        texture.medium = MEDIUM_LAVA;
        EXPECT_EQ(find_texinfo_media(bsp, { &texture, 1 }), std::vector<uint32_t> { MEDIUM_LAVA });
    }
    formats::Bsp wall = make_pool(formats::CONTENTS_WATER);
    wall.texinfos[0].flags = 0;
    EXPECT_EQ(medium_of_face(wall, 0, 0, MEDIUM_SLIME), MEDIUM_NONE) << "no liquid";
}

TEST(Media, LavaShinesAndIsOpaque)
{
    formats::Bsp bsp = make_pool(formats::CONTENTS_LAVA);
    light_lava(bsp, find_texinfo_media(bsp));
    EXPECT_TRUE(bsp.texinfos[0].flags & formats::SURF_LIGHT);
    EXPECT_FALSE(bsp.texinfos[0].flags & formats::SURF_TRANS66);
    EXPECT_GT(bsp.texinfos[0].value, 0);
    bsp.texinfos[0].value = 500; // the author's own
    light_lava(bsp, find_texinfo_media(bsp));
    EXPECT_EQ(bsp.texinfos[0].value, 500);
    formats::Bsp water = make_pool(formats::CONTENTS_WATER);
    light_lava(water, find_texinfo_media(water));
    EXPECT_FALSE(water.texinfos[0].flags & formats::SURF_LIGHT);
}

TEST(Media, BoxesHoldAllOfThem)
{
    const std::vector<FilterBox> of_leaf = find_liquid_boxes(make_pool(formats::CONTENTS_WATER));
    ASSERT_EQ(of_leaf.size(), 1u);
    EXPECT_EQ(of_leaf[0].mins, glm::vec3(-64));
    std::vector<FilterBox> boxes;
    for (int i = 0; i < 100; i++) {
        const glm::vec3 corner(float(i % 10) * 500 + float(i) * 3, float(i / 50) * 4000, 0);
        add_filter_box(boxes, { corner, corner + 10.0f });
    }
    ASSERT_EQ(boxes.size(), MAX_FILTER_BOXES);
    for (int i = 0; i < 100; i++) {
        const glm::vec3 centre = glm::vec3(float(i % 10) * 500 + float(i) * 3, float(i / 50) * 4000, 0) + 5.0f;
        bool inside = false;
        for (const FilterBox& box : boxes)
            inside |= glm::clamp(centre, box.mins, box.maxs) == centre;
        EXPECT_TRUE(inside) << i;
    }
}

} // namespace
} // namespace vkpt::test
