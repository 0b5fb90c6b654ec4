// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/view_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>

namespace vkpt::trace {

namespace {

int64_t distance(uint32_t a, uint32_t b) { return std::abs(int64_t(int32_t(a - b))); }

template <size_t count> std::array<uint32_t, count> words_of(const void* bytes)
{
    std::array<uint32_t, count> words;
    std::memcpy(words.data(), bytes, sizeof words);
    return words;
}

// An entity without its two pointers, and their numbers in front.
constexpr size_t model_word = 0, skin_word = 1, entity_origin = 5;
struct EntityWords {
    uint32_t model, skin;
    float angles[3], origin[3];
    int32_t frame;
    float previous_origin[3];
    int32_t previous_frame;
    float backlerp;
    int32_t skin_number, lightstyle;
    float alpha;
    int32_t flags;
};
static_assert(sizeof(EntityWords) == 18 * 4 && offsetof(EntityWords, origin) == entity_origin * 4);

std::array<uint32_t, 18> pack(const View::Entity& from)
{
    const engine::Entity& e = from.entity;
    EntityWords to { from.model, from.skin, {}, {}, e.frame, {}, e.previous_frame, e.backlerp, e.skin_number,
        e.lightstyle, e.alpha, e.flags };
    std::ranges::copy(e.angles, to.angles);
    std::ranges::copy(e.origin, to.origin);
    std::ranges::copy(e.previous_origin, to.previous_origin);
    return std::bit_cast<std::array<uint32_t, 18>>(to);
}

View::Entity unpack(const std::array<uint32_t, 18>& words)
{
    const auto from = std::bit_cast<EntityWords>(words);
    View::Entity to;
    to.model = from.model;
    to.skin = from.skin;
    engine::Entity& e = to.entity = {};
    std::ranges::copy(from.angles, e.angles);
    std::ranges::copy(from.origin, e.origin);
    std::ranges::copy(from.previous_origin, e.previous_origin);
    e.frame = from.frame;
    e.previous_frame = from.previous_frame;
    e.backlerp = from.backlerp;
    e.skin_number = from.skin_number;
    e.lightstyle = from.lightstyle;
    e.alpha = from.alpha;
    e.flags = from.flags;
    return to;
}

template <size_t count>
bool is_near(const std::array<uint32_t, count>& a, const std::array<uint32_t, count>& b, size_t first, float reach)
{
    for (size_t i = first; i < first + 3; i++)
        if (!(std::abs(std::bit_cast<float>(a[i]) - std::bit_cast<float>(b[i])) < reach))
            return false;
    return true;
}

constexpr size_t not_found = SIZE_MAX;

// How far a thing may have moved since the last view, in Quake units, to be taken for the same. Only a matter of size.
constexpr float entity_reach = 150, particle_reach = 40;

} // namespace

// The highest of the orders "as before", "as fast as before" and "as evenly accelerated as before" would have foretold
// the newest value best.
uint32_t WordHistory::guess() const
{
    const auto& v = values_;
    if (count_ < 3)
        return v[0];
    const int64_t steady = distance(v[0], v[1]), linear = distance(v[0], 2 * v[1] - v[2]);
    const int64_t quadratic = count_ < 4 ? INT64_MAX : distance(v[0], 3 * v[1] - 3 * v[2] + v[3]);
    if (steady <= linear && steady <= quadratic)
        return v[0];
    return linear <= quadratic ? 2 * v[0] - v[1] : 3 * v[0] - 3 * v[1] + v[2];
}

// Each item names the one of the last view that it goes on from, or none; then its words' errors, word by word for all
// items, because like stands beside like for the compressor.
template <class Coder, size_t count, class Match>
void ViewCodec::code_list(
    Coder& coder, std::vector<std::array<uint32_t, count>>& items, List<count>& last, Match find_last)
{
    uint32_t size = uint32_t(items.size());
    coder.number(size);
    if constexpr (!Coder::is_encoder) {
        if (size > uint32_t(engine::max_particles)) // the largest of the lists
            coder.fail("a view with more things than the engine can show");
        items.resize(size);
    }
    List<count> now(size);
    const std::vector<size_t> matches = Coder::is_encoder ? find_last() : std::vector<size_t>(size, not_found);
    uint32_t expected = 1; // numbered from 1; 0: none
    for (size_t i = 0; i < size; i++) {
        uint32_t place = matches[i] == not_found ? 0 : uint32_t(matches[i]) + 1;
        coder.near_number(place, expected);
        coder.check(place <= last.size(), "a thing that continues one that does not exist");
        if (place > 0) {
            now[i].history = last[place - 1].history;
            expected = place + 1;
        }
    }
    for (size_t word = 0; word < count; word++)
        for (size_t i = 0; i < size; i++) {
            coder.near_number(items[i][word], now[i].history[word].guess());
            now[i].history[word].push(items[i][word]);
        }
    for (size_t i = 0; i < size; i++)
        now[i].words = items[i];
    last = std::move(now);
}

template <class Coder> void ViewCodec::code_lightstyles(Coder& coder, View& view)
{
    uint32_t has = view.has_lightstyles;
    coder.number(has);
    view.has_lightstyles = has != 0;
    if (!has)
        return;
    uint32_t changed = 0;
    if constexpr (Coder::is_encoder)
        for (size_t i = 0; i < lightstyles_.size(); i++)
            changed += std::memcmp(&view.lightstyles[i], &lightstyles_[i], sizeof(engine::Lightstyle)) != 0;
    coder.number(changed);
    uint32_t place = 0;
    for (uint32_t n = 0; n < changed; n++) {
        if constexpr (Coder::is_encoder)
            while (std::memcmp(&view.lightstyles[place], &lightstyles_[place], sizeof(engine::Lightstyle)) == 0)
                place++;
        coder.number(place);
        coder.check(place < lightstyles_.size(), "a lightstyle that does not exist");
        auto words = std::bit_cast<std::array<uint32_t, 4>>(view.lightstyles[place]);
        const auto before = std::bit_cast<std::array<uint32_t, 4>>(lightstyles_[place]);
        for (size_t i = 0; i < words.size(); i++)
            coder.near_number(words[i], before[i]);
        lightstyles_[place] = std::bit_cast<engine::Lightstyle>(words);
        place++;
    }
    view.lightstyles = lightstyles_;
}

template <class Coder> void ViewCodec::code_area_bits(Coder& coder, View& view)
{
    uint32_t has = view.has_area_bits ? 1 + (view.area_bits != area_bits_) : 0; // 2: changed
    coder.number(has);
    view.has_area_bits = has != 0;
    if (has == 2)
        for (size_t i = 0; i < max_area_bytes; i++) {
            uint32_t byte = view.area_bits[i];
            coder.number(byte);
            area_bits_[i] = uint8_t(byte);
        }
    if (has)
        view.area_bits = area_bits_;
}

namespace {

// For each thing of a view the one of the view before that it goes on from, or not_found.

// The engine sorts entities by model and skin: the next one like it that is near.
template <class Items, class Known> std::vector<size_t> match_entities(const Items& now_all, const Known& before_all)
{
    std::vector<size_t> matches(now_all.size(), not_found);
    std::vector<bool> taken(before_all.size());
    for (size_t i = 0; i < now_all.size(); i++)
        for (size_t k = 0; k < before_all.size() && matches[i] == not_found; k++) {
            const auto &now = now_all[i], &before = before_all[k].words;
            if (!taken[k] && now[model_word] == before[model_word] && now[skin_word] == before[skin_word]
                && is_near(now, before, entity_origin, entity_reach)) {
                matches[i] = k;
                taken[k] = true;
            }
        }
    return matches;
}

template <class Items, class Known> std::vector<size_t> match_by_place(const Items& now_all, const Known& before_all)
{
    std::vector<size_t> matches(now_all.size(), not_found);
    for (size_t i = 0; i < std::min(now_all.size(), before_all.size()); i++)
        matches[i] = i;
    return matches;
}

// The client puts new particles in front and takes the dead out from anywhere: from the end, the next one of this
// colour that is near.
template <class Items, class Known> std::vector<size_t> match_particles(const Items& now_all, const Known& before_all)
{
    constexpr size_t dead_at_once = 64, color_word = 3;
    std::vector<size_t> matches(now_all.size(), not_found);
    size_t end = before_all.size();
    for (size_t i = now_all.size(); i-- > 0 && end > 0;)
        for (size_t k = end; k-- > (end > dead_at_once ? end - dead_at_once : 0);) {
            const auto &now = now_all[i], &before = before_all[k].words;
            if (now[color_word] == before[color_word] && is_near(now, before, 0, particle_reach)) {
                matches[i] = end = k;
                break;
            }
        }
    return matches;
}

} // namespace

template <class Coder> void ViewCodec::code(Coder& coder, View& view)
{
    static_assert(offsetof(engine::RefDef, area_bits) == head_words * 4);
    auto head = words_of<head_words>(&view.refdef);
    for (size_t i = 0; i < head_words; i++) {
        coder.near_number(head[i], head_[i].guess());
        head_[i].push(head[i]);
    }
    code_area_bits(coder, view);
    code_lightstyles(coder, view);

    std::vector<std::array<uint32_t, entity_words>> entities;
    std::vector<std::array<uint32_t, light_words>> lights;
    std::vector<std::array<uint32_t, particle_words>> particles;
    if constexpr (Coder::is_encoder) {
        for (const View::Entity& entity : view.entities)
            entities.push_back(pack(entity));
        for (const engine::DynamicLight& light : view.dlights)
            lights.push_back(words_of<light_words>(&light));
        for (const engine::Particle& particle : view.particles)
            particles.push_back(words_of<particle_words>(&particle));
    }
    code_list(coder, entities, entities_, [&] { return match_entities(entities, entities_); });
    code_list(coder, lights, lights_, [&] { return match_by_place(lights, lights_); });
    code_list(coder, particles, particles_, [&] { return match_particles(particles, particles_); });
    if constexpr (!Coder::is_encoder) {
        std::memcpy(&view.refdef, head.data(), sizeof head);
        if (entities.size() > size_t(engine::max_entities) || lights.size() > size_t(engine::max_dlights))
            coder.fail("a view with more things than the engine can show");
        for (const auto& words : entities)
            view.entities.push_back(unpack(words));
        for (const auto& words : lights)
            view.dlights.push_back(std::bit_cast<engine::DynamicLight>(words));
        for (const auto& words : particles)
            view.particles.push_back(std::bit_cast<engine::Particle>(words));
    }
}

template void ViewCodec::code(Encoder&, View&);
template void ViewCodec::code(Decoder&, View&);

} // namespace vkpt::trace
