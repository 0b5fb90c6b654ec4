// SPDX-License-Identifier: GPL-2.0-or-later
// Words of vkpt's command line: scenes, sizes and settings.
#include "client/host/errors.hpp"
#include "client/host/scene_name.hpp"
#include "client/options.hpp"
#include "fuzz/support/harness.hpp"

#include <cmath>

namespace {

template <class Parse> void try_to(Parse parse)
{
    try {
        parse();
    } catch (const vkpt::client::WrongUse&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    const std::string text(fuzz::text_of(data, size));
    try_to([&] {
        const client::SceneName scene = client::parse_scene_name(text);
        fuzz::require(scene.map.ends_with(".bsp"), "a scene is a map");
        if (scene.camera)
            fuzz::require(
                std::isfinite(scene.camera->position.x) && std::isfinite(scene.camera->yaw), "cameras are finite");
    });
    try_to([&] {
        const client::Size picture = client::parse_size(text);
        fuzz::require(picture.width > 0 && picture.height > 0, "a picture's size is positive");
    });
    try_to([&] { fuzz::require(!client::parse_settings({ text }, "--set")[0].first.empty(), "a setting has a name"); });
    return 0;
}
