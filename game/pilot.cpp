// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt::game {

namespace {

using Way = Navigation::Way;

constexpr float reached = 14, reached_height = 28; // units
constexpr float turn_rate = 240, pitch_rate = 45; // degrees a second
constexpr size_t farthest_look = 16; // nodes ahead that one goes straight to

float level_length(glm::vec3 v) { return std::hypot(v.x, v.y); }

} // namespace

float wrap_degrees(float degrees) { return degrees - 360 * std::round(degrees / 360); }

void Pilot::reset(glm::vec3 angles)
{
    path_.clear();
    behind_ = Navigation::none;
    angles_ = angles;
}

void Pilot::follow(uint32_t from, std::vector<uint32_t> path)
{
    behind_ = from;
    path_ = std::move(path);
    jumped_ = false;
}

void Pilot::pass_nodes(const Navigation& navigation, const PlayerView& player)
{
    const auto& nodes = navigation.nodes();
    // What lies farther along and is reached already makes what is before it needless.
    for (size_t i = std::min(path_.size(), farthest_look); i-- > 0;) {
        const glm::vec3 delta = nodes[path_[i]].position - player.origin;
        if (level_length(delta) > reached || std::abs(delta.z) > (player.in_water ? 20 : reached_height))
            continue;
        const uint32_t before = i > 0 ? path_[i - 1] : behind_;
        const Navigation::Edge* edge = before != Navigation::none ? navigation.find_edge(before, path_[i]) : nullptr;
        if (edge && edge->way == Way::ride && delta.z > 10)
            continue; // still rising
        behind_ = path_[i];
        path_.erase(path_.begin(), path_.begin() + std::ptrdiff_t(i) + 1);
        jumped_ = false;
        return;
    }
}

// The farthest node on the path that one can walk straight to.
glm::vec3 Pilot::look_ahead(const Navigation& navigation, const PlayerView& player) const
{
    const auto& nodes = navigation.nodes();
    glm::vec3 best = nodes[path_.front()].position;
    uint32_t before = behind_;
    for (size_t i = 0; i < std::min(path_.size(), farthest_look); i++) {
        const Navigation::Edge* edge = before != Navigation::none ? navigation.find_edge(before, path_[i]) : nullptr;
        if (!edge || edge->way != Way::walk)
            break;
        if (navigation.is_straight_walk(player.origin, nodes[path_[i]].position))
            best = nodes[path_[i]].position;
        before = path_[i];
    }
    return best;
}

void Pilot::turn_towards(glm::vec3 direction, float seconds)
{
    if (level_length(direction) < 1)
        return;
    const float yaw = glm::degrees(std::atan2(direction.y, direction.x));
    const float pitch = std::clamp(
        glm::degrees(std::atan2(-direction.z, std::max(level_length(direction), 64.0f))) * 0.5f, -30.0f, 30.0f);
    const float turn = wrap_degrees(yaw - angles_.y), most = turn_rate * seconds;
    // Fast while far off, softly at the end.
    angles_.y = wrap_degrees(angles_.y + std::clamp(turn * std::min(1.0f, 6 * seconds), -most, most));
    const float nod = pitch_rate * seconds;
    angles_.x += std::clamp((pitch - angles_.x) * std::min(1.0f, 3 * seconds), -nod, nod);
}

Inputs Pilot::steer(const Navigation& navigation, const PlayerView& player, float seconds)
{
    Inputs inputs;
    if (!path_.empty())
        pass_nodes(navigation, player);
    if (path_.empty()) {
        inputs.angles = angles_;
        return inputs;
    }
    const auto& nodes = navigation.nodes();
    const Navigation::Edge* edge = behind_ != Navigation::none ? navigation.find_edge(behind_, path_.front()) : nullptr;
    const Way way = edge ? edge->way : Way::walk;
    const glm::vec3 next = nodes[path_.front()].position;
    const glm::vec3 target = way == Way::walk ? look_ahead(navigation, player) : next;
    glm::vec3 delta = target - player.origin;
    const float distance = level_length(delta);

    if (way == Way::ride && next.z - player.origin.z > 10) {
        inputs.move = glm::vec3(0); // the lift does it
    } else if (distance > 1) {
        inputs.move = glm::vec3(delta.x, delta.y, 0) / distance;
        // Before a bend one brakes, so as not to run over the edge behind it.
        const float speed = level_length(player.velocity);
        const float along = speed > 1 ? glm::dot(inputs.move, player.velocity) / speed : 1;
        if (player.on_ground && speed > 100 && along < 0.7f)
            inputs.move *= 0.3f;
    }
    if (player.in_water) {
        inputs.climb = std::clamp(delta.z / 16 + (nodes[path_.front()].swims ? 0.1f : 1.0f), -1.0f, 1.0f);
    } else if (way == Way::jump && player.on_ground && !jumped_) {
        const glm::vec3 start = nodes[behind_].position;
        const bool is_leap = level_length(next - start) > 1.5f * Navigation::step * 1.5f;
        const float speed = glm::dot(player.velocity, inputs.move);
        // A step is jumped at once; a leap wants a run-up, and the brink.
        if (!is_leap || (speed > 200 && level_length(player.origin - start) < 40)) {
            inputs.climb = 1;
            jumped_ = true;
        } else if (is_leap && level_length(player.origin - start) > 24 && speed > 0) {
            inputs.climb = 1;
            jumped_ = true;
        }
    }
    turn_towards(delta, seconds);
    inputs.angles = angles_;
    return inputs;
}

} // namespace vkpt::game
