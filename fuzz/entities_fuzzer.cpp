// SPDX-License-Identifier: GPL-2.0-or-later
// A map's entities: parsed, read as numbers and places, as point lights, and as brush models that stand somewhere.
#include "client/host/client_map.hpp"
#include "formats/entities.hpp"
#include "fuzz/support/harness.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/suns.hpp"
#include "tests/formats/samples.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    static formats::Bsp map = samples::make_bsp();
    const std::string_view text = fuzz::text_of(data, size);
    try {
        const std::vector<formats::EntityText> entities = formats::parse_entities(text, "input");
        for (const formats::EntityText& entity : entities) {
            for (const auto& [key, value] : entity.pairs) {
                fuzz::use(entity.number(key, 1));
                fuzz::use(entity.vector(key));
            }
            fuzz::use(client::place_brush_model(entity, map.models[0], entities));
        }
        for (const Sun& sun : find_suns(entities)) {
            const shared::Emitter emitter = make_sun(sun, glm::vec3(1));
            fuzz::require(emitter.p1.x > 0 && emitter.radiance == emitter.radiance, "suns are spheres with a size");
        }
        map.entity_text = text;
        std::vector<std::string> messages;
        for (const shared::Emitter& emitter : extract_point_lights(map, {}, messages))
            fuzz::require(
                emitter.p1.x > 0 && emitter.radiance == emitter.radiance, "point lights are spheres with a size");
    } catch (const formats::FormatError&) {
    }
    return 0;
}
