// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/calibrate_light/variants.hpp"

#include "formats/entities.hpp"

namespace vkpt::tools {

namespace {

std::string write_without_lights(const formats::Bsp& bsp)
{
    std::string text;
    for (const formats::EntityText& entity : formats::parse_entities(bsp.entity_text, bsp.name)) {
        if (entity.class_name() == "light")
            continue;
        text += "{\n";
        for (const auto& [key, value] : entity.pairs)
            text += "\"" + key + "\" \"" + value + "\"\n";
        text += "}\n";
    }
    return text;
}

} // namespace

const char* name_of(LightKind kind)
{
    switch (kind) {
    case LightKind::face:
        return "face";
    case LightKind::point:
        return "point";
    case LightKind::sky:
        return "sky";
    }
    return "?";
}

formats::Bsp keep_lights_of(const formats::Bsp& bsp, LightKind kind)
{
    formats::Bsp variant = bsp;
    if (kind != LightKind::point)
        variant.entity_text = write_without_lights(bsp);
    for (formats::BspTexinfo& texinfo : variant.texinfos) {
        const bool is_sky = texinfo.flags & formats::SURF_SKY;
        const bool keeps = is_sky ? kind == LightKind::sky : kind == LightKind::face;
        if (!keeps)
            texinfo.flags &= ~uint32_t(formats::SURF_LIGHT);
    }
    return variant;
}

} // namespace vkpt::tools
