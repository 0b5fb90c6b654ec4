// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/canvas.hpp"
#include "tools/asset_generator/surface.hpp"

#include "formats/bsp.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
using namespace formats;

// A flat colour with its purpose written on it, for the editor's view.
Recipe label(std::string_view text, glm::vec3 colour)
{
    const float wanted = 0.24f;
    const float height = wanted * std::min(1.0f, 0.84f / text_width(text, wanted));
    const TextShape shape
        = text_shape(text, { 0.5f - text_width(text, height) * 0.5f, 0.5f - height * 0.5f }, height, height * 0.18f);
    return [=](glm::vec2 uv) {
        const bool edge = wrapped_box(uv, glm::vec2(0.03f), glm::vec2(0.97f)) > 0;
        const bool checker = (int(uv.x * 8) + int(uv.y * 8)) & 1;
        if (edge || shape(uv) < 0)
            return Surface { glm::vec3(0.95f), 0 };
        return Surface { colour * (checker ? 1.0f : 0.86f), 0 };
    };
}
}

std::vector<Texture> tool_textures()
{
    return {
        { "vkpt/clip", 64, label("CLIP", { 0.62f, 0.16f, 0.52f }), SURF_NODRAW,
            CONTENTS_PLAYERCLIP | CONTENTS_MONSTERCLIP },
        { "vkpt/trigger", 64, label("TRIGGER", { 0.72f, 0.44f, 0.08f }), SURF_NODRAW },
        { "vkpt/origin", 64, label("ORIGIN", { 0.12f, 0.50f, 0.62f }), SURF_NODRAW, 0x1000000 },
        { "vkpt/hint", 64, label("HINT", { 0.20f, 0.54f, 0.20f }), SURF_HINT | SURF_NODRAW },
        { "vkpt/skip", 64, label("SKIP", { 0.36f, 0.36f, 0.42f }), SURF_SKIP | SURF_NODRAW },
        { "vkpt/nodraw", 64, label("NODRAW", { 0.48f, 0.12f, 0.12f }), SURF_NODRAW },
    };
}

} // namespace vkpt::tools
