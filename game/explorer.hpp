// SPDX-License-Identifier: GPL-2.0-or-later
// Wanders through a map by itself, towards places not yet seen, without getting stuck.
#pragma once

#include "game/navigation.hpp"
#include "game/pilot.hpp"
#include "game/random.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::game {

class Explorer {
public:
    explicit Explorer(uint32_t seed);
    void set_lifts(std::vector<Lift> lifts) { navigation_.set_lifts(std::move(lifts)); }

    // What put the player elsewhere since the last frame.
    enum class Arrival { none, teleported, reborn };
    // Once a server frame: learns the map, and decides where to go.
    void think(const Space& space, const PlayerView& player, Arrival arrival);
    // Several times a frame.
    Inputs steer(const PlayerView& player, float seconds);
    void reset_view(glm::vec3 angles) { pilot_.reset(angles); }
    // Instead of wandering: goes to a place, or with clear_goal() nowhere.
    void set_goal(glm::vec3 place);
    void clear_goal();
    bool has_arrived(const PlayerView& player) const;
    // For so long without getting anywhere that only another life helps: wedged into a crack of the map.
    bool is_trapped() const { return trapped_frames_ > trapped_limit; }
    static constexpr int trapped_limit = 60; // frames
    bool has_given_up() const { return gave_up_; } // the map is known, and there is no way to the goal

    const Navigation& navigation() const { return navigation_; }
    size_t seen_count() const { return seen_count_; }

private:
    void look_around(glm::vec3 origin);
    void note_landing(const Space& space, const PlayerView& player, Arrival arrival);
    void watch_progress(const PlayerView& player);
    void watch_area(const PlayerView& player);
    void leave_way();
    void stray();
    void steer_flight(const PlayerView& player);
    void choose_path(const Space& space, const PlayerView& player);
    std::vector<uint32_t> find_unseen(uint32_t start);
    std::vector<uint32_t> find_goal(uint32_t start);

    enum class Purpose { wander, goal, nothing };

    Purpose purpose_ = Purpose::wander;
    glm::vec3 goal_ { 0 };
    bool is_map_known_ = false, gave_up_ = false;
    Navigation navigation_;
    Pilot pilot_;
    void give_up(uint32_t goal);

    std::vector<bool> seen_; // by node
    std::vector<uint8_t> tries_; // by node: how often it was the goal, and was not reached
    size_t seen_count_ = 0;
    uint32_t seed_;
    Random random_;
    uint32_t time_ = 0; // frames
    uint32_t last_ground_ = Navigation::none; // node
    int in_air_ = 0; // frames
    glm::vec3 progress_place_ { 0 };
    uint32_t progress_time_ = 0;
    glm::vec3 area_place_ { 0 };
    uint32_t area_time_ = 0;
    int stray_ = 0; // frames that it goes anywhere, to come free
    glm::vec3 stray_direction_ { 0 };
    uint32_t plan_again_ = 0;
    glm::vec3 trap_place_ { 0 };
    int trapped_frames_ = 0;
};

} // namespace vkpt::game
