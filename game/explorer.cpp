// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/explorer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt::game {

namespace {

constexpr int nodes_per_frame = 600;
constexpr float seen_distance = 52; // units
constexpr uint32_t stuck_frames = 12, blocked_frames = 600; // of a tenth of a second
constexpr float min_progress = 24; // units in stuck_frames
constexpr int stray_frames = 8;
constexpr float min_area = 160; // units: who wanders leaves so small an area within area_frames
constexpr uint32_t area_frames = 80;
constexpr uint8_t max_tries = 3; // for a place
constexpr float goal_distance = 32; // units
constexpr uint32_t idle_frames = 10; // before looking for a way again where there was none

} // namespace

Explorer::Explorer(uint32_t seed)
    : seed_(seed)
    , random_(seed + 1)
{
}

void Explorer::look_around(glm::vec3 origin)
{
    seen_.resize(navigation_.nodes().size(), false);
    tries_.resize(navigation_.nodes().size(), 0);
    for (const uint32_t node : navigation_.find_all_near(origin, seen_distance)) {
        seen_count_ += !seen_[node];
        seen_[node] = true;
    }
}

// Where a jump pad or a teleporter led: known from now on.
void Explorer::note_landing(const Space& space, const PlayerView& player, Arrival arrival)
{
    constexpr int long_flight = 8; // frames: longer than any jump
    if (!player.on_ground && !player.in_water) {
        in_air_++;
        return;
    }
    if (in_air_ > long_flight)
        stray_ = 0; // landed
    const uint32_t here = navigation_.find_or_add(space, player.origin);
    if (here != Navigation::none) {
        const bool was_thrown = in_air_ > long_flight || arrival == Arrival::teleported;
        if (last_ground_ != Navigation::none && arrival != Arrival::reborn && was_thrown)
            navigation_.note_passage(last_ground_, here);
        last_ground_ = here;
    }
    in_air_ = 0;
}

void Explorer::watch_progress(const PlayerView& player)
{
    constexpr float trapped_move = 4; // units
    trapped_frames_ = glm::distance(player.origin, trap_place_) < trapped_move ? trapped_frames_ + 1 : 0;
    if (trapped_frames_ == 0)
        trap_place_ = player.origin;
    if (glm::distance(player.origin, progress_place_) > min_progress) {
        progress_place_ = player.origin;
        progress_time_ = time_;
        return;
    }
    if (time_ - progress_time_ < stuck_frames)
        return;
    progress_time_ = time_;
    leave_way();
}

// To and fro on one staircase is no progress, either.
void Explorer::watch_area(const PlayerView& player)
{
    if (glm::distance(player.origin, area_place_) > min_area) {
        area_place_ = player.origin;
        area_time_ = time_;
        return;
    }
    if (time_ - area_time_ < area_frames)
        return;
    area_time_ = time_;
    if (pilot_.has_path() && !seen_.empty())
        give_up(pilot_.goal());
    leave_way();
}

// Not on along this way for a while: anywhere.
void Explorer::leave_way()
{
    if (pilot_.has_path()) {
        if (pilot_.behind() != Navigation::none)
            navigation_.block(pilot_.behind(), pilot_.target(), time_ + blocked_frames);
        pilot_.drop_path();
    }
    stray();
}

// Thrown up by a jump pad, it has to leave the pad's column: towards what is not seen yet, if some is near.
void Explorer::steer_flight(const PlayerView& player)
{
    constexpr int thrown = 9, steered = 40; // frames in the air: after longer than any jump
    constexpr float reach = 320, farthest_up = 100; // units
    if (in_air_ != thrown || purpose_ != Purpose::wander)
        return;
    pilot_.drop_path();
    stray();
    stray_ = steered;
    float nearest = reach;
    for (uint32_t node = 0; node < seen_.size(); node++) {
        const glm::vec3 delta = navigation_.nodes()[node].position - player.origin;
        const float distance = std::hypot(delta.x, delta.y);
        if (seen_[node] || distance >= nearest || distance < 1 || std::abs(delta.z) > farthest_up)
            continue;
        nearest = distance;
        stray_direction_ = glm::vec3(delta.x, delta.y, 0) / distance;
    }
}

void Explorer::stray()
{
    stray_ = stray_frames;
    const float angle = random_.between(0, 6.2831853f);
    stray_direction_ = { std::cos(angle), std::sin(angle), 0 };
}

std::vector<uint32_t> Explorer::find_unseen(uint32_t start)
{
    // Not always the very nearest: other seeds, other tours.
    constexpr uint32_t choices = 3, apart = 16;
    uint32_t skip = seed_ == 0 ? 0 : random_.next() % choices * apart;
    const auto is_wanted = [&](uint32_t node) { return !seen_[node] && tries_[node] < max_tries; };
    auto path = navigation_.find_path(start, time_, [&](uint32_t node) { return is_wanted(node) && skip-- == 0; });
    if (path.empty())
        path = navigation_.find_path(start, time_, is_wanted);
    if (!path.empty()) {
        if (++tries_[path.back()] == max_tries)
            give_up(path.back());
        return path;
    }
    // What could not be reached may be reached from elsewhere.
    std::ranges::fill(tries_, uint8_t(0));
    // All is seen, or out of reach: anywhere.
    const uint32_t goal = random_.next() % uint32_t(seen_.size());
    path = navigation_.find_path(start, time_, [&](uint32_t node) { return node == goal; });
    if (!path.empty() && seen_[goal]) {
        seen_[goal] = false;
        seen_count_--;
    }
    return path;
}

// It and what is next to it are left for the end.
void Explorer::give_up(uint32_t goal)
{
    constexpr float near = 64; // units
    for (const uint32_t node : navigation_.find_all_near(navigation_.nodes()[goal].position, near))
        tries_[node] = max_tries;
}

std::vector<uint32_t> Explorer::find_goal(uint32_t start)
{
    const auto& nodes = navigation_.nodes();
    auto path = navigation_.find_path(
        start, time_, [&](uint32_t node) { return glm::distance(nodes[node].position, goal_) < goal_distance; });
    gave_up_ = path.empty() && is_map_known_;
    return path;
}

void Explorer::choose_path(const Space& space, const PlayerView& player)
{
    if (purpose_ == Purpose::nothing)
        return;
    if (pilot_.has_path() && (purpose_ == Purpose::goal || !seen_[pilot_.goal()]))
        return;
    if (time_ < plan_again_ || (!player.on_ground && !player.in_water))
        return;
    uint32_t start = navigation_.find_or_add(space, player.origin);
    if (start == Navigation::none)
        start = navigation_.find_near(player.origin);
    if (start == Navigation::none) {
        stray(); // as on a train: off it, to ground that stays
        return;
    }
    seen_.resize(navigation_.nodes().size(), false);
    tries_.resize(navigation_.nodes().size(), 0);
    auto path = purpose_ == Purpose::goal ? find_goal(start) : find_unseen(start);
    if (path.empty())
        plan_again_ = time_ + idle_frames;
    else
        pilot_.follow(start, std::move(path));
}

void Explorer::set_goal(glm::vec3 place)
{
    purpose_ = Purpose::goal;
    goal_ = place;
    gave_up_ = false;
    plan_again_ = 0;
    pilot_.drop_path();
}

void Explorer::clear_goal()
{
    purpose_ = Purpose::nothing;
    pilot_.drop_path();
}

bool Explorer::has_arrived(const PlayerView& player) const
{
    return glm::distance(player.origin, goal_) < goal_distance + Navigation::step;
}

void Explorer::think(const Space& space, const PlayerView& player, Arrival arrival)
{
    time_++;
    if (arrival != Arrival::none) {
        pilot_.drop_path();
        progress_place_ = player.origin;
        progress_time_ = time_;
    }
    note_landing(space, player, arrival);
    is_map_known_ = !navigation_.grow(space, nodes_per_frame);
    look_around(player.origin);
    if (purpose_ != Purpose::nothing)
        watch_progress(player);
    if (purpose_ == Purpose::wander)
        watch_area(player);
    steer_flight(player);
    if (stray_ > 0)
        stray_--;
    else
        choose_path(space, player);
}

Inputs Explorer::steer(const PlayerView& player, float seconds)
{
    Inputs inputs = pilot_.steer(navigation_, player, seconds);
    if (stray_ > 0) {
        inputs.move = stray_direction_;
        inputs.climb = player.in_water || stray_ % 4 == 0 ? 1.0f : 0.0f;
    }
    return inputs;
}

} // namespace vkpt::game
