// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/dynamic_lights.hpp"

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
using Kind = std::array<uint32_t, 6>;

Kind kind_of(const Emitter& e)
{
    if (e.type == shared::EMITTER_SPHERE)
        return { e.type, e.lightstyle, 0, 0, 0, 0 };
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    return { e.type, e.lightstyle, bits(e.area), bits(e.radiance.x), bits(e.radiance.y), bits(e.radiance.z) };
}

// Last frame's slots of one kind that nobody has claimed yet, ascending, and this frame's emitters still without one.
struct Candidates {
    std::vector<uint32_t> slots;
    std::vector<size_t> emitters;
    size_t next = 0; // where the search for what stands still begins: lights mostly come in the order of the last frame
};

constexpr uint32_t none = UINT32_MAX;

// The candidate where `emitter` is, and claims it.
uint32_t claim_same_place(Candidates& candidates, const Emitter& emitter, const std::vector<Emitter>& last)
{
    const auto is_here = [&](uint32_t slot) { return last[slot].p0 == emitter.p0; };
    std::vector<uint32_t>& free = candidates.slots;
    const auto start = free.begin() + ptrdiff_t(std::min(candidates.next, free.size()));
    auto found = std::find_if(start, free.end(), is_here);
    if (found == free.end()) {
        found = std::find_if(free.begin(), start, is_here);
        if (found == start)
            return none;
    }
    const uint32_t slot = *found;
    candidates.next = size_t(found - free.begin());
    free.erase(found);
    return slot;
}

// What has moved: the closest pairs first.
void claim_nearest(const Candidates& candidates, const std::vector<Emitter>& emitters, const std::vector<Emitter>& last,
    std::vector<uint32_t>& slots)
{
    struct Pair {
        float distance2;
        size_t emitter;
        uint32_t slot;
    };
    std::vector<Pair> pairs;
    for (const size_t i : candidates.emitters)
        for (const uint32_t slot : candidates.slots) {
            const glm::vec3 move = emitters[i].p0 - last[slot].p0;
            const float distance2 = glm::dot(move, move);
            if (distance2 <= DynamicLights::farthest_move * DynamicLights::farthest_move)
                pairs.push_back({ distance2, i, slot });
        }
    std::ranges::stable_sort(pairs, {}, &Pair::distance2);
    std::set<uint32_t> claimed;
    for (const Pair& pair : pairs)
        if (slots[pair.emitter] == none && claimed.insert(pair.slot).second)
            slots[pair.emitter] = pair.slot;
}

} // namespace

std::vector<uint32_t> DynamicLights::arrange(std::vector<Emitter>& emitters)
{
    std::map<Kind, Candidates> kinds;
    for (uint32_t slot = 0; slot < last_.size(); slot++)
        if (used_[slot])
            kinds[kind_of(last_[slot])].slots.push_back(slot);

    std::vector<uint32_t> slots(emitters.size(), none);
    for (size_t i = 0; i < emitters.size(); i++) {
        Candidates& candidates = kinds[kind_of(emitters[i])];
        slots[i] = claim_same_place(candidates, emitters[i], last_);
        if (slots[i] == none)
            candidates.emitters.push_back(i);
    }
    for (const auto& [kind, candidates] : kinds)
        claim_nearest(candidates, emitters, last_, slots);
    std::vector<bool> used(last_.size(), false);
    for (const uint32_t slot : slots)
        if (slot != none)
            used[slot] = true;
    lived_before_ = used;

    uint32_t first_free = 0;
    for (uint32_t& slot : slots) {
        if (slot != none)
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
