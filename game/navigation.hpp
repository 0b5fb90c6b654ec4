// SPDX-License-Identifier: GPL-2.0-or-later
// Where a player can stand and swim in a map, and how to get from there to there: a graph that grows from places known
// to be good, by trying a player's moves with traces. Knows no engine.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

namespace vkpt::game {

// What a map is to somebody who walks in it. Positions are of the player's origin, 24 units above the feet.
class Space {
public:
    struct Hit {
        float fraction = 1; // of the way, 1: free
        glm::vec3 end { 0 }, normal { 0 };
        bool starts_solid = false;
    };
    enum class Medium { air, water, deadly };

    virtual ~Space() = default;
    // A standing player's box, moved; doors let it through.
    virtual Hit move(glm::vec3 from, glm::vec3 to) const = 0;
    virtual Medium medium(glm::vec3 p) const = 0;
};

// A platform that lifts who stands on it by `travel`.
struct Lift {
    glm::vec3 mins { 0 }, maxs { 0 }; // at its lowest
    float travel = 0;
};

class Navigation {
public:
    enum class Way : uint8_t { walk, jump, fall, swim, ride, thrown };
    struct Edge {
        uint32_t to;
        Way way;
        float cost; // about units of way at full speed
        uint32_t blocked_until = 0; // a time of the caller's
    };
    struct Node {
        glm::vec3 position;
        bool swims = false, is_grown = false;
        std::vector<Edge> edges;
    };

    void set_lifts(std::vector<Lift> lifts) { lifts_ = std::move(lifts); }
    // The node where a player at `p` is, made if need be; `none` if nobody can be there, or only falling.
    uint32_t find_or_add(const Space& space, glm::vec3 p);
    // The nearest known node within a few steps; `none`: there is none.
    uint32_t find_near(glm::vec3 p) const;
    std::vector<uint32_t> find_all_near(glm::vec3 p, float distance) const;
    // Tries the moves from up to so many nodes that were not tried. False: nothing is left to try.
    bool grow(const Space& space, int max_nodes);
    // What was seen to be possible without being known: jump pads, teleporters.
    void note_passage(uint32_t from, uint32_t to);
    void block(uint32_t from, uint32_t to, uint32_t until);

    // The cheapest way from `start` to the nearest node that `is_wanted`; empty: none. The path begins behind `start`.
    template <typename Wanted>
    std::vector<uint32_t> find_path(uint32_t start, uint32_t now, const Wanted& is_wanted) const;
    const Edge* find_edge(uint32_t from, uint32_t to) const;
    // Whether one can walk straight from a to b: known ground all along.
    bool is_straight_walk(glm::vec3 a, glm::vec3 b) const;

    const std::vector<Node>& nodes() const { return nodes_; }

    static constexpr uint32_t none = UINT32_MAX;
    static constexpr float step = 16; // between nodes, units
    static constexpr float stair = 18; // what a player walks up

private:
    struct Search {
        std::vector<uint32_t> came_from;
        std::vector<float> costs;
    };
    // Nodes in the order of their cost from `start`; `visit` ends it by returning true.
    template <typename Visit> uint32_t search(uint32_t start, uint32_t now, Search& state, const Visit& visit) const;

    static uint64_t key_of(glm::vec3 p);
    uint32_t find_at(glm::vec3 p, float tolerance) const;
    uint32_t add(glm::vec3 p, bool swims);
    void link(uint32_t from, glm::vec3 to, Way way, float extra_cost, bool swims = false);
    void grow_node(const Space& space, uint32_t node);
    void try_direction(const Space& space, uint32_t node, glm::vec3 direction);
    std::optional<Way> try_level(const Space& space, uint32_t node, glm::vec3 ahead);
    bool try_step(const Space& space, uint32_t node, glm::vec3 ahead, float height, Way way);
    void try_leap(const Space& space, uint32_t node, glm::vec3 direction);
    void try_swimming(const Space& space, uint32_t node);
    void try_lifts(const Space& space, uint32_t node);
    // The way that it became: deep ones are falls. nullopt: there is no landing.
    std::optional<Way> land(const Space& space, uint32_t from, glm::vec3 above, Way way, float extra_cost);

    std::vector<Node> nodes_;
    std::vector<uint32_t> to_grow_;
    size_t next_to_grow_ = 0;
    std::unordered_map<uint64_t, std::vector<uint32_t>> by_column_;
    std::vector<Lift> lifts_;
};

} // namespace vkpt::game

#include "game/navigation_search.hpp"
