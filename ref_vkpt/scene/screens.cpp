// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/screens.hpp"

#include "ref_vkpt/lights/animated_lights.hpp"
#include "ref_vkpt/lights/media.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <tuple>

namespace vkpt {

namespace {

// What sends the path on, or ends it, before it could meet a screen.
constexpr uint32_t no_screens = shared::MATERIAL_SKY | shared::MATERIAL_WARP | shared::MATERIAL_TRANSLUCENT
    | shared::MATERIAL_ALPHA_TEST | shared::MATERIAL_FULLBRIGHT;

// One entry for each camera and area that are shown.
class Table {
public:
    Table(const World& world)
        : world_(world)
    {
    }

    // Nothing: it is full.
    std::optional<uint32_t> find(size_t camera, glm::vec4 area, glm::uvec2 texture_size)
    {
        const Key key(camera, area, texture_size);
        const auto known = std::ranges::find(keys_, key);
        if (known == keys_.end()) {
            if (keys_.size() == shared::MAX_SCREENS)
                return std::nullopt;
            keys_.push_back(key);
            screens_.push_back(make_screen(world_, world_.cameras[camera], area, texture_size));
            return uint32_t(keys_.size() - 1);
        }
        return uint32_t(known - keys_.begin());
    }
    std::vector<shared::Screen> take() { return std::move(screens_); }

private:
    using Key = std::tuple<size_t, glm::vec4, glm::uvec2>;
    const World& world_;
    std::vector<Key> keys_;
    std::vector<shared::Screen> screens_;
};

} // namespace

size_t choose_camera(const World& world, size_t texinfo, float time)
{
    const formats::BspTexinfo& info = world.bsp.texinfos[texinfo];
    const size_t count = world.cameras.size();
    if (!(info.flags & formats::SURF_LIGHT) && info.value >= 1 && size_t(info.value) <= count)
        return size_t(info.value - 1);
    // Screens begin at different ones.
    const auto turn = uint64_t(std::clamp(time / seconds_per_camera, 0.0f, 1e9f));
    return size_t((turn + texinfo) % count);
}

shared::Screen make_screen(
    const World& world, const formats::SecurityCamera& camera, glm::vec4 area, glm::uvec2 texture_size)
{
    const glm::vec3 forward = camera.forward;
    constexpr float steepest = 0.99f;
    const glm::vec3 upright = std::abs(forward.z) < steepest ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, upright)), up = glm::cross(right, forward);
    shared::Screen screen {};
    screen.area_mins = glm::vec2(area);
    screen.area_size = glm::vec2(area.z, area.w) - glm::vec2(area);
    const float half_across = std::tan(glm::radians(camera.fov_x) / 2);
    const float half_down
        = half_across * screen.area_size.y * float(texture_size.y) / (screen.area_size.x * float(texture_size.x));
    screen.eye = camera.eye;
    screen.across = right * (2 * half_across);
    screen.down = up * (-2 * half_down);
    screen.corner = forward - 0.5f * (screen.across + screen.down);
    screen.medium = medium_at(world.bsp, camera.eye);
    return screen;
}

std::vector<shared::Screen> find_screens(
    const World& world, const MaterialLibrary& library, float time, std::vector<shared::Material>& materials)
{
    if (world.cameras.empty())
        return {};
    Table table(world);
    const uint32_t count = uint32_t(world.bsp.texinfos.size());
    const int tick = animation_tick(time);
    // Of a texinfo, and of what is shown in its place now.
    const auto mark = [&](uint32_t texinfo, uint32_t shown, shared::Material& material) {
        const MaterialSettings* settings = library.find(world.material_names[shown]);
        if (!settings || !settings->is_screen || (material.flags & no_screens))
            return;
        const glm::uvec2 size(material.texture_size & 0xffff, material.texture_size >> 16);
        if (const auto number = table.find(choose_camera(world, texinfo, time), settings->screen_area, size))
            material.flags |= shared::MATERIAL_SCREEN | *number << shared::MATERIAL_SCREEN_SHIFT;
    };
    for (uint32_t i = 0; i < count; i++) {
        mark(i, world.animation_frame(i, tick) - count, materials[i]);
        mark(i, i, materials[count + i]);
    }
    return table.take();
}

} // namespace vkpt
