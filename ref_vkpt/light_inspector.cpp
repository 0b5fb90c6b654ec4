// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/light_inspector.hpp"

#include "common/numbers.hpp"
#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/module.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <map>

namespace vkpt {

namespace {

constexpr size_t max_lights = 4096; // of a list
constexpr size_t printed_rows = 16, panel_rows = 8;
constexpr std::chrono::milliseconds between_looks { 250 };
constexpr const char* nothing_there = "no lit surface is under the crosshair";

const char* name_of_type(uint32_t type)
{
    switch (type) {
    case shared::EMITTER_SPHERE:
        return "point light";
    case shared::EMITTER_SKY:
        return "sky";
    case shared::EMITTER_SUN:
        return "sun";
    }
    return "lamp";
}

// Of one light: its emitters are added up. What samplers report as probability is, of some, only a number to divide by.
void add_emitter(LightRow& row, const InspectedLight& emitter, const InspectedSurface& surface)
{
    const float distance = glm::distance(emitter.centre, surface.position);
    row.distance = row.name.empty() ? distance : std::min(row.distance, distance);
    row.chosen += double(emitter.picked) / std::max(surface.choices, 1u);
    row.share += double(emitter.weight);
    row.name = name_of_type(emitter.type);
}

std::vector<LightRow> make_rows(
    const Module& m, MapLights& lights, const InspectedSurface& surface, const std::vector<InspectedLight>& emitters)
{
    const size_t fixed = m.scene.world()->models[0].emitters.size(), suns_end = fixed + lights.sun_count();
    std::map<uint32_t, LightRow> by_light; // those that move behind the map's
    double sum = 0;
    for (const InspectedLight& emitter : emitters) {
        const bool is_fixed = emitter.emitter < suns_end; // suns are the first behind the map's emitters
        const uint32_t light = emitter.emitter < fixed ? lights.light_of(emitter.emitter)
            : is_fixed                                 ? lights.light_of_sun(emitter.emitter - fixed)
                                                       : uint32_t(lights.light_count()) + emitter.emitter;
        LightRow& row = by_light[light];
        add_emitter(row, emitter, surface);
        sum += double(emitter.weight);
        if (!is_fixed)
            row.name += " that moves";
        else
            row.light = light;
        if (is_fixed && lights.is_lamp(light))
            row.name += " " + lights.texture_of(light);
    }
    std::vector<LightRow> rows;
    for (auto& [light, row] : by_light) {
        row.share = sum > 0 ? row.share / sum : 0;
        rows.push_back(std::move(row));
    }
    std::ranges::stable_sort(rows, std::ranges::greater(), [](const LightRow& row) { return row.chosen; });
    return rows;
}

std::string describe_row(size_t number, const LightRow& row)
{
    return fmt::format("{:3} {:6.2f}% {:6.2f}% {:6.0f}  {}", number, 100 * row.chosen, 100 * row.share,
        double(row.distance), row.name);
}

constexpr const char* heading = "  #  chosen   light  units  what it is";

// 1, 2 ...: of the rows; 0: no such row.
size_t read_number(std::string_view text, size_t count)
{
    const size_t number = parse_number<size_t>(text).value_or(0);
    return number <= count ? number : 0;
}

} // namespace

void LightInspector::look(Module& m)
{
    rows_.clear();
    place_ = nothing_there;
    looked_ = std::chrono::steady_clock::now();
    if (!m.scene.world() || !m.view().snapshot || m.view().snapshot->world != m.scene.world()
        || m.graphics.is_recording())
        return;
    const Viewpoint& shown = m.view().viewpoint;
    InspectedSurface surface {};
    std::vector<InspectedLight> emitters(max_lights);
    if (!m.queries().inspect_pixel(glm::uvec2(shown.origin) + shown.size / 2u, surface, emitters) || surface.depth < 0)
        return;
    emitters.resize(std::min<size_t>(surface.light_count, max_lights));
    MapLights& lights = m.scene.map_lights();
    rows_ = make_rows(m, lights, surface, emitters);
    place_ = fmt::format("{} lights in {} emitters", rows_.size(), surface.light_count);
    if (const size_t muted = lights.muted_count(); muted > 0)
        place_ += fmt::format("; muted: {}", muted);
}

void LightInspector::print() const
{
    engine::print("pt_lights: {}", place_);
    if (rows_.empty())
        return;
    engine::print("    by {}", cvars::values().pt_light_sampler);
    engine::print("{}", heading);
    for (size_t i = 0; i < std::min(rows_.size(), printed_rows); i++)
        engine::print("{}", describe_row(i + 1, rows_[i]));
    if (rows_.size() > printed_rows)
        engine::print("    and {} less probable ones", rows_.size() - printed_rows);
}

void LightInspector::change(Module& m, bool solo)
{
    const std::string_view text = engine::argument(2);
    const size_t number = read_number(text, rows_.size());
    if (number == 0)
        return engine::print("pt_lights: \"{}\" is no row of the last list, which has {}; `pt_lights` lists what is "
                             "under the crosshair",
            text, rows_.size());
    const LightRow& row = rows_[number - 1];
    if (!row.light)
        return engine::print("pt_lights: {} is not the map's, and stays (pt_dlight_scale dims the engine's)", row.name);
    MapLights& lights = m.scene.map_lights();
    std::vector<bool> muted = solo ? std::vector<bool>(lights.light_count(), true) : lights.muted();
    muted[*row.light] = !solo;
    lights.mute(std::move(muted));
    engine::print("pt_lights: {} is {}; `pt_lights all` takes it back", row.name, solo ? "alone" : "muted");
}

void LightInspector::run(Module& m)
{
    const std::string_view word = engine::argument(1);
    if (!m.scene.world())
        return engine::print("pt_lights: there is no map: start one first");
    if (word.empty()) {
        look(m);
        return print();
    }
    if (word == "all" && engine::argument_count() == 2)
        m.scene.map_lights().mute(std::vector<bool>(m.scene.map_lights().light_count(), false));
    else if ((word == "mute" || word == "solo") && engine::argument_count() == 3)
        change(m, word == "solo");
    else
        return engine::print(
            "usage: pt_lights, pt_lights mute N, pt_lights solo N, pt_lights all; N is a row's number");
    m.renew_scene();
    looked_ = {};
}

void LightInspector::update(Module& m)
{
    if (cvars::values().pt_show_lights != 0 && std::chrono::steady_clock::now() - looked_ >= between_looks)
        look(m);
}

std::vector<PanelLine> LightInspector::describe() const
{
    if (cvars::values().pt_show_lights == 0)
        return {};
    std::vector<PanelLine> lines { { place_, true } };
    if (!rows_.empty())
        lines.push_back({ heading, true });
    for (size_t i = 0; i < std::min(rows_.size(), panel_rows); i++)
        lines.push_back({ describe_row(i + 1, rows_[i]) });
    return lines;
}

} // namespace vkpt
