// SPDX-License-Identifier: GPL-2.0-or-later
#include "sampler_lists.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vkpt::test {

namespace {

constexpr uint32_t index_stride = 3;

void face_the_point(shared::Emitter& e)
{
    if (glm::dot(e.p0, glm::cross(e.p1 - e.p0, e.p2 - e.p0)) > 0)
        std::swap(e.p1, e.p2);
}

shared::Emitter make_triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, float radiance)
{
    shared::Emitter e {};
    e.type = shared::EMITTER_TRIANGLE;
    e.p0 = a;
    e.p1 = b;
    e.p2 = c;
    e.radiance = glm::vec3(radiance);
    face_the_point(e);
    return e;
}

shared::Emitter make_random_light(std::mt19937& rng)
{
    std::uniform_real_distribution<float> unit(0, 1);
    const auto around = [&](float size) { return size * (glm::vec3(unit(rng), unit(rng), unit(rng)) - 0.5f); };
    const glm::vec3 centre(400 * (unit(rng) - 0.5f), 400 * (unit(rng) - 0.5f), 40 + 200 * unit(rng));
    const float radiance = std::exp(6 * unit(rng) - 3);
    if (rng() % 4 != 0)
        return make_triangle(centre, centre + around(40), centre + around(40), radiance);
    shared::Emitter e {};
    e.type = shared::EMITTER_SPHERE;
    e.radiance = glm::vec3(radiance);
    e.p0 = centre;
    e.p1 = glm::vec3(1 + 8 * unit(rng), 0, 0);
    if (rng() % 4 == 0) // the point lies in the cone, in its edge, or beyond
        set_cone(e, glm::normalize(around(2) - glm::normalize(centre)), 0.8f, 0.5f);
    return e;
}

// Seen as before, but far away.
void make_sun(shared::Emitter& sphere)
{
    const float half_angle = sphere.p1.x / glm::length(sphere.p0);
    sphere.type = shared::EMITTER_SUN;
    sphere.p0 = glm::normalize(sphere.p0) * shared::SUN_DISTANCE;
    sphere.p1.x = shared::SUN_DISTANCE * half_angle;
}

// The list's second part is the dynamic one, which suns belong to; both begin somewhere in their tables.
void fill_list(ListCase& list, const std::vector<uint32_t>& indices)
{
    constexpr uint32_t first_static = 5, first_dynamic = 2;
    const size_t dynamic_count = indices.size() / 3;
    list.range = { first_static, uint32_t(indices.size() - dynamic_count), first_dynamic, uint32_t(dynamic_count) };
    list.static_indices.assign(first_static, 0);
    list.dynamic_indices.assign(first_dynamic, 0);
    const auto middle = indices.end() - long(dynamic_count);
    for (auto index = middle; index != indices.end(); ++index)
        if (shared::Emitter& e = list.emitters[*index];
            e.type == shared::EMITTER_SPHERE && !has_cone(e) && *index % 2 == 0)
            make_sun(e);
    list.static_indices.insert(list.static_indices.end(), indices.begin(), middle);
    list.dynamic_indices.insert(list.dynamic_indices.end(), middle, indices.end());
    // Behind the list, each light once, twice, four or eight times: any numbers are right, but where what is near is
    // rare, estimates take too long to converge.
    constexpr uint32_t max_exponent = 3;
    constexpr float near = 20;
    shared::LightMultiset multiset { uint32_t(list.static_indices.size()), 0 };
    for (auto index = indices.begin(); index != middle; ++index) {
        const bool is_near = glm::length(list.emitters[*index].p0) < near;
        const uint32_t exponent = is_near ? max_exponent : (*index * 2654435761u) >> 30u;
        list.static_indices.insert(
            list.static_indices.end(), size_t(1) << exponent, *index | exponent << shared::LIGHT_COPIES_SHIFT);
    }
    multiset.count = uint32_t(list.static_indices.size()) - multiset.first;
    list.make_tables(multiset);
}

void lower(shared::Emitter& e)
{
    constexpr float below = -500;
    e.p0.z = below;
    if (!is_sphere(e))
        e.p1.z = e.p2.z = below;
}

void make_dark(shared::Emitter& e, size_t how)
{
    if (how % 3 == 0)
        e.radiance = glm::vec3(0);
    else if (how % 3 == 1 || e.type == shared::EMITTER_SPHERE)
        lower(e);
    else
        std::swap(e.p1, e.p2);
}

} // namespace

ListCase make_random_list(size_t count, double zero_share, uint32_t seed)
{
    std::mt19937 rng(seed);
    ListCase list;
    std::vector<uint32_t> indices;
    for (size_t i = 0; i < count * index_stride; i++) {
        shared::Emitter e = make_random_light(rng);
        if (double(rng() % 1000) < 1000 * zero_share)
            make_dark(e, i);
        e.lightstyle = i % 7 == 0 ? 3 : 0;
        list.emitters.push_back(e);
        if (i % index_stride == 0)
            indices.push_back(uint32_t(i));
    }
    list.lightstyles[3] = 0.4f;
    fill_list(list, indices);
    return list;
}

ListCase make_hard_list(size_t count, uint32_t seed)
{
    std::mt19937 rng(seed);
    ListCase list;
    std::vector<uint32_t> indices;
    const auto add = [&](const shared::Emitter& e) {
        if (indices.size() < count)
            indices.push_back(uint32_t(list.emitters.size()));
        list.emitters.push_back(e);
    };
    // Vertical, standing on the surface, close by.
    add(make_triangle({ 2, -3, 0 }, { 2, 3, 0 }, { 2, 0, 4 }, 0.3f));
    add(make_triangle({ -1, 6, 0 }, { 4, 6, 0 }, { 0, 6, 9 }, 0.5f));
    // Through the horizon.
    add(make_triangle({ -60, -40, -50 }, { -60, 0, 80 }, { -60, 40, -30 }, 1));
    while (indices.size() < count) {
        const size_t i = list.emitters.size();
        shared::Emitter e = make_random_light(rng);
        if (i % 5 == 0)
            make_dark(e, i / 5);
        if (i % 11 == 0 && e.type == shared::EMITTER_TRIANGLE)
            e.type = shared::EMITTER_TRANSPARENT;
        if (i % 7 == 0 && e.type == shared::EMITTER_TRIANGLE)
            list.emitters.push_back(e); // not in the list
        else
            add(e);
    }
    fill_list(list, indices);
    return list;
}

ListCase make_uneven_list()
{
    constexpr int count = 64, stride = 8;
    ListCase list;
    std::vector<uint32_t> indices;
    for (int i = 0; i < count; i++) {
        const glm::vec3 centre(60.0f * float(i % 8), 60.0f * float(i / 8) - 210, 60);
        const float size = 28, radiance = i % stride == 0 ? 10.0f : 0.01f;
        list.emitters.push_back(make_triangle(centre + glm::vec3(-size, -size, 0), centre + glm::vec3(size, -size, 0),
            centre + glm::vec3(0, size, 0), radiance));
        indices.push_back(uint32_t(i));
    }
    fill_list(list, indices);
    return list;
}

bool has_fixed_probabilities(const Sampler& sampler)
{
    const ListCase list = make_random_list(64, 0, 5);
    std::mt19937 rng(1);
    const float first = sampler.probability(list, list.light_at(20), make_draw(rng), {});
    for (int i = 0; i < 16; i++)
        if (sampler.probability(list, list.light_at(20), make_draw(rng), {}) != first)
            return false;
    return true;
}

std::vector<uint32_t> subset_lengths(const Sampler& sampler)
{
    if (sampler.has(shared::SAMPLER_USES_SUBSET))
        return { 1, 8, 64 };
    return { 8 };
}

} // namespace vkpt::test
