// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/dynamic_lights.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/geometric.hpp>
#include <map>
#include <set>

namespace vkpt {

namespace {

using shared::Emitter;

// Emitters that may be each other in different frames have equal kinds. A dying flash changes its radiance.
using Kind = std::array<uint32_t, 5>;

Kind kind_of(const Emitter& e)
{
    if (is_sphere(e))
        return { e.type, e.lightstyle, 0, 0, 0 };
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    return { e.type, e.lightstyle, bits(e.radiance.x), bits(e.radiance.y), bits(e.radiance.z) };
}

constexpr uint32_t no_slot = UINT32_MAX;

// Last frame's slots of one kind, ascending, that this frame's emitters claim.
class Candidates {
public:
    void add(uint32_t slot)
    {
        slots_.push_back(slot);
        is_free_.push_back(true);
    }

    // The slot where `emitter` is. The search begins behind the last one found: lights mostly come in the order of the
    // last frame.
    uint32_t claim_same_place(const Emitter& emitter, const std::vector<Emitter>& last)
    {
        if (next_ < slots_.size() && is_free_[next_] && last[slots_[next_]].p0 == emitter.p0)
            return claim(next_, last);
        if (emitter.p0 != emitter.p0) // NaN
            return no_slot;
        if (!is_indexed_)
            index(last);
        const auto place = places_.find(key_of(emitter.p0));
        if (place == places_.end() || place->second.empty())
            return no_slot;
        const auto behind = place->second.lower_bound(next_);
        return claim(behind != place->second.end() ? *behind : *place->second.begin(), last);
    }

    std::vector<uint32_t> free_slots() const
    {
        std::vector<uint32_t> free;
        for (size_t i = 0; i < slots_.size(); i++)
            if (is_free_[i])
                free.push_back(slots_[i]);
        return free;
    }

    std::vector<size_t> emitters; // this frame's, still without a slot

private:
    using Key = std::array<float, 3>;
    static Key key_of(glm::vec3 p) { return { p.x, p.y, p.z }; }

    void index(const std::vector<Emitter>& last)
    {
        is_indexed_ = true;
        for (size_t i = 0; i < slots_.size(); i++)
            if (const glm::vec3 p = last[slots_[i]].p0; is_free_[i] && p == p)
                places_[key_of(p)].insert(i);
    }

    uint32_t claim(size_t i, const std::vector<Emitter>& last)
    {
        if (is_indexed_)
            places_[key_of(last[slots_[i]].p0)].erase(i);
        is_free_[i] = false;
        next_ = i + 1;
        return slots_[i];
    }

    std::vector<uint32_t> slots_;
    std::vector<bool> is_free_;
    size_t next_ = 0;
    bool is_indexed_ = false;
    std::map<Key, std::set<size_t>> places_; // of the free ones, by where they are; made when it is needed
};

constexpr float farthest_move2 = DynamicLights::farthest_move * DynamicLights::farthest_move;
// Of all kinds in one frame; their number grows with the square of the lights of one kind. Sorting so many takes some
// 20 ms.
constexpr size_t max_pairs = 1 << 18;

float move2(const Emitter& emitter, const Emitter& last)
{
    const glm::vec3 move = emitter.p0 - last.p0;
    return glm::dot(move, move);
}

// What has moved: the closest pairs first.
void claim_nearest(const std::vector<size_t>& moved, const std::vector<uint32_t>& free,
    const std::vector<Emitter>& emitters, const std::vector<Emitter>& last, std::vector<uint32_t>& slots)
{
    struct Pair {
        float distance2;
        size_t emitter;
        uint32_t slot;
    };
    std::vector<Pair> pairs;
    for (const size_t i : moved)
        for (const uint32_t slot : free)
            if (const float distance2 = move2(emitters[i], last[slot]); distance2 <= farthest_move2)
                pairs.push_back({ distance2, i, slot });
    std::ranges::stable_sort(pairs, {}, &Pair::distance2);
    std::set<uint32_t> claimed;
    for (const Pair& pair : pairs)
        if (slots[pair.emitter] == no_slot && claimed.insert(pair.slot).second)
            slots[pair.emitter] = pair.slot;
}

// What has moved, where it is too much to compare: the lights of what moves as one come in the same order every frame.
void claim_in_order(const std::vector<size_t>& moved, const std::vector<uint32_t>& free,
    const std::vector<Emitter>& emitters, const std::vector<Emitter>& last, std::vector<uint32_t>& slots)
{
    for (size_t i = 0; i < std::min(moved.size(), free.size()); i++)
        if (move2(emitters[moved[i]], last[free[i]]) <= farthest_move2)
            slots[moved[i]] = free[i];
}

} // namespace

std::vector<uint32_t> DynamicLights::arrange(std::vector<Emitter>& emitters)
{
    std::map<Kind, Candidates> kinds;
    for (uint32_t slot = 0; slot < last_.size(); slot++)
        if (used_[slot])
            kinds[kind_of(last_[slot])].add(slot);

    std::vector<uint32_t> slots(emitters.size(), no_slot);
    for (size_t i = 0; i < emitters.size(); i++) {
        Candidates& candidates = kinds[kind_of(emitters[i])];
        slots[i] = candidates.claim_same_place(emitters[i], last_);
        if (slots[i] == no_slot)
            candidates.emitters.push_back(i);
    }
    size_t pairs = 0;
    for (const auto& [kind, candidates] : kinds) {
        const std::vector<uint32_t> free = candidates.free_slots();
        pairs += candidates.emitters.size() * free.size();
        const auto claim = pairs <= max_pairs ? claim_nearest : claim_in_order;
        claim(candidates.emitters, free, emitters, last_, slots);
    }
    std::vector<bool> used(last_.size(), false);
    for (const uint32_t slot : slots)
        if (slot != no_slot)
            used[slot] = true;
    lived_before_ = used;

    uint32_t first_free = 0;
    for (uint32_t& slot : slots) {
        if (slot != no_slot)
            continue;
        while (first_free < used.size() && used[first_free])
            first_free++;
        if (first_free == used.size())
            used.push_back(false);
        used[first_free] = true;
        slot = first_free;
    }
    while (!used.empty() && !used.back())
        used.pop_back();

    std::vector<Emitter> arranged(used.size());
    for (size_t i = 0; i < emitters.size(); i++)
        arranged[slots[i]] = emitters[i];
    lived_before_.resize(used.size(), false);
    used_ = std::move(used);
    last_ = arranged;
    emitters = std::move(arranged);
    return slots;
}

} // namespace vkpt
