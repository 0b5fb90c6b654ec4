// SPDX-License-Identifier: GPL-2.0-or-later
// A lit room for modules that start under the layer of faults, which no other test's module has.
#pragma once

#include "tests/fault_layer/faults.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace vkpt::tests {

class FaultyRoom : public testing::Test {
protected:
    FaultyRoom()
        : cube_path_(folder_.add_cube("cube", 10, red_index))
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_lit_room("wall");
        folder_.add_map("room", map.finish());
        Session::end_idle();
    }
    ~FaultyRoom() override { Session::end_idle(); }

    // Rays by the software backend.
    std::unique_ptr<Session> start_in(glm::ivec2 size, CvarList cvars = {}) const
    {
        cvars.insert(cvars.end(), { { "pt_device_rays", "0" }, { "pt_trace", "software" } });
        return std::make_unique<Session>(folder_, cvars, size);
    }

    static void enter(Session& session)
    {
        session.load_map("room");
        session.look({ -100, -100, 80 }, { 60, 60, 20 });
    }
    engine::Entity make_cube(Session& session, glm::vec3 origin) const
    {
        return make_entity(session.module().register_model(cube_path_.c_str()), origin);
    }

    GameFolder folder_;

private:
    std::string cube_path_;
};

} // namespace vkpt::tests
