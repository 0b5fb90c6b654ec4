// SPDX-License-Identifier: GPL-2.0-or-later
// The device's memory runs out while a map is loaded: the level is dropped, the game goes on.
#include "client/host/errors.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class OutOfMemory : public testing::Test {
protected:
    OutOfMemory()
    {
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_lit_room("missing");
        folder_.add_map("room", map.finish());
        cube_path_ = folder_.add_cube("cube", 10, red_index);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_VKPT_faults", 1);
        setenv("VK_LAYER_PATH", VKPT_FAULT_LAYER ":/usr/share/vulkan/explicit_layer.d", 1);
        setenv("VKPT_FAULTS", (faults_.path() / "faults").c_str(), 1);
    }
    ~OutOfMemory() override
    {
        for (const char* name : { "VK_INSTANCE_LAYERS", "VK_LAYER_PATH", "VKPT_FAULTS" })
            unsetenv(name);
    }

    // Every allocation of device memory but the next `count` fails from here on.
    void allow(int count) const { faults_.write("faults", "memory " + std::to_string(count) + "\n"); }
    void allow_all() const { std::filesystem::remove(faults_.path() / "faults"); }

    Radiance draw(Session& session) const
    {
        session.load_map("room");
        engine::Entity cube = make_entity(session.module().register_model(cube_path_.c_str()), { 0, 0, 40 });
        session.view.entities = &cube;
        session.view.entity_count = 1;
        session.look({ -100, 0, 50 }, { 100, 0, 50 });
        session.draw(2);
        session.view.entity_count = 0;
        return session.capture();
    }

    GameFolder folder_;
    ScratchFolder faults_;
    std::string cube_path_;
};

TEST_F(OutOfMemory, DropsTheLevelWhereverItHappens)
{
    const Radiance undisturbed = [&] {
        Session session(folder_);
        return draw(session);
    }();
    int dropped = 0;
    for (int count = 0;; count++) {
        SCOPED_TRACE(count);
        ASSERT_LT(count, 100);
        Session session(folder_);
        allow(count);
        try {
            draw(session);
            allow_all();
            break; // no more was needed
        } catch (const client::Failure& error) {
            dropped++;
            EXPECT_NE(std::string(error.what()).find("pt_render_scale"), std::string::npos) << error.what();
        }
        allow_all();
        EXPECT_TRUE(draw(session) == undisturbed) << "the next level suffers from the dropped one";
    }
    EXPECT_GT(dropped, 0) << "the layer is not there";
}

} // namespace
} // namespace vkpt::tests
