// SPDX-License-Identifier: GPL-2.0-or-later
// The game module's files of lights (after an `l`) and walks: read, written and read again, which gives the same.
#include "fuzz/support/harness.hpp"
#include "game/light_text.hpp"
#include "game/walk_text.hpp"

namespace {

using namespace vkpt;

void check_lights(std::string_view text)
{
    const std::vector<game::Light> lights = game::parse_light_file(text, "input");
    fuzz::require(lights.size() <= game::max_lights, "no more lights than there may be");
    for (const game::Light& light : lights) {
        const formats::CodedLight back = formats::decode_light(formats::encode_light(game::code_light(light, 1)));
        fuzz::require(back.value > 0 && back.radius > 0, "a light can be told to the renderer");
    }
    const std::string written = game::write_light_file(lights, "m");
    fuzz::require(game::write_light_file(game::parse_light_file(written, "again"), "m") == written,
        "what was written is read the same");
}

void check_walk(std::string_view text)
{
    const std::vector<game::WalkAction> actions = game::parse_walk_file(text, "input");
    fuzz::require(actions.size() <= game::max_walk_actions, "no more actions than there may be");
    const std::string written = game::write_walk_file(actions, "m");
    fuzz::require(game::write_walk_file(game::parse_walk_file(written, "again"), "m") == written,
        "what was written is read the same");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size == 0)
        return 0;
    const std::string_view text = fuzz::text_of(data + 1, size - 1);
    try {
        if (data[0] == 'l')
            check_lights(text);
        else
            check_walk(text);
    } catch (const game::TextError&) {
    }
    return 0;
}
