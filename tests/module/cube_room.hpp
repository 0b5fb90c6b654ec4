// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of a lit room with one red cube, which may move.
#pragma once

#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <gtest/gtest.h>
#include <memory>

namespace vkpt::tests {

inline constexpr glm::vec3 players_eye { -100, -60, 60 }, players_target { 100, 60, 40 };

class CubeRoomTest : public testing::Test {
protected:
    void start(const CvarList& cvars = {}, glm::ivec2 size = { 64, 48 })
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_lit_room("wall");
        folder_.add_map("room", map.finish());
        const std::string cube = folder_.add_cube("cube", 8, red_index);
        CvarList all { { "pt_player_body", "0" } };
        all.insert(all.end(), cvars.begin(), cvars.end());
        session_ = std::make_unique<Session>(folder_, all, size);
        session_->load_map("room");
        cube_ = make_entity(session_->module().register_model(cube.c_str()), { 40, 0, 30 });
        session_->view.entities = &cube_;
        session_->view.entity_count = 1;
        session_->look(players_eye, players_target);
    }
    void run(const std::string& text) { session_->host().run_text(text + "\n"); }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
    engine::Entity cube_ {};
};

} // namespace vkpt::tests
