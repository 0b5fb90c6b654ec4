// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/server_space.hpp"

#include "formats/byte_reader.hpp"
#include "formats/entities.hpp"

#include <algorithm>

namespace vkpt::game {

namespace {

// Broader than a player by a unit to each side, so that one gets past corners without having to be exact.
constexpr Box player_box { { -17, -17, -24 }, { 17, 17, 32 } };
// Without monsters and other players: they go away.
constexpr int mask_walls = mask_solid | CONTENTS_PLAYERCLIP;
constexpr float default_lip = 8;

// Inline model "*N" has config string N + 1 on every server.
int model_index_of(int inline_model) { return inline_model + 1; }

template <typename Visit> void visit_brush_entities(const Host& host, const Visit& visit)
{
    for (int number = 1; number < host.game->edict_count; number++)
        if (Edict* edict = host.edict(number); is_true(edict->in_use) && edict->solid == SOLID_BSP)
            visit(*edict);
}

} // namespace

BrushEntities read_brush_entities(std::string_view entity_text)
{
    constexpr std::string_view giving_way[] { "func_door", "func_door_rotating", "func_door_secret", "func_train" };
    BrushEntities result;
    try {
        for (const formats::EntityText& entity : formats::parse_entities(entity_text, "the map's entities")) {
            const std::optional<size_t> model = formats::brush_model_index(entity.get("model"));
            if (!model)
                continue;
            const int number = int(*model);
            if (std::ranges::find(giving_way, entity.class_name()) != std::end(giving_way))
                result.doors.push_back(number);
            else if (entity.class_name() == "func_plat" && entity.get("targetname").empty())
                result.platforms.push_back({ number, entity.number("height", 0), entity.number("lip", default_lip) });
        }
    } catch (const formats::FormatError&) {
        // The game reads the same text and has said so.
    }
    return result;
}

ServerSpace::ServerSpace(const Host& host, const BrushEntities& brushes, const Edict& player)
    : host_(host)
    , player_(player)
{
    visit_brush_entities(host, [&](Edict& edict) {
        for (const int door : brushes.doors)
            if (edict.state.model == model_index_of(door))
                opened_.push_back(&edict);
    });
    for (Edict* edict : opened_)
        edict->solid = SOLID_NOT;
}

ServerSpace::~ServerSpace()
{
    for (Edict* edict : opened_)
        edict->solid = SOLID_BSP;
}

Space::Hit ServerSpace::move(glm::vec3 from, glm::vec3 to) const
{
    const Trace trace = host_.trace(from, to, player_box, &player_, mask_walls);
    return { trace.fraction, to_vec3(trace.end), to_vec3(trace.plane.normal), is_true(trace.start_solid) };
}

Space::Medium ServerSpace::medium(glm::vec3 p) const
{
    const int contents = host_.contents(p);
    if (contents & (CONTENTS_LAVA | CONTENTS_SLIME))
        return Medium::deadly;
    return contents & CONTENTS_WATER ? Medium::water : Medium::air;
}

std::vector<Lift> find_lifts(const Host& host, const BrushEntities& brushes)
{
    std::vector<Lift> lifts;
    visit_brush_entities(host, [&](const Edict& edict) {
        for (const BrushEntities::Platform& platform : brushes.platforms) {
            if (edict.state.model != model_index_of(platform.model))
                continue;
            const float travel = platform.height > 0 ? platform.height : edict.size[2] - platform.lip;
            const glm::vec3 border(1); // of absolute bounds
            lifts.push_back({ to_vec3(edict.absolute_mins) + border, to_vec3(edict.absolute_maxs) - border, travel });
        }
    });
    return lifts;
}

} // namespace vkpt::game
