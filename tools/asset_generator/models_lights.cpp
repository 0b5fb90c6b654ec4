// SPDX-License-Identifier: GPL-2.0-or-later
// What stands where the game module's lights are (formats/light_code.hpp).
#include "formats/light_code.hpp"
#include "tools/asset_generator/mesh.hpp"
#include "tools/asset_generator/output.hpp"

#include <cmath>
#include <string>

namespace vkpt::tools {

namespace {

using M = Material;
constexpr float pi = 3.14159265f;

std::string_view path_of(formats::LightModel model) { return formats::light_models[size_t(model)]; }

// A tube, open in front, that the light shines out of: how long it is for its width decides the cone.
formats::Md2Model make_spot()
{
    constexpr int sides = 16;
    constexpr float radius = 2.5f, back = -2.5f;
    Mesh mesh;
    mesh.begin_part(0);
    for (int i = 0; i < sides; i++) {
        const auto rim = [&](int n) {
            const float a = 2 * pi * float(n) / sides;
            return glm::vec3(0, std::cos(a), std::sin(a)) * radius;
        };
        const glm::vec3 front(1, 0, 0);
        mesh.quad(rim(i), rim(i + 1), rim(i + 1) + front, rim(i) + front, M::gunmetal);
    }
    mesh.begin_part(1);
    mesh.tube({ back - 1.5f, 0, 0 }, { back, 0, 0 }, radius * 0.7f, radius * 1.05f, M::gunmetal, M::dark_steel, sides);
    std::vector<Pose> poses;
    for (const int cone : formats::spot_cones) {
        const float length = radius / std::tan(float(cone) * pi / 360) - back;
        poses.push_back({ "cone" + std::to_string(cone), { move({ back, 0, 0 }) * stretch({ length, 1, 1 }) } });
    }
    return mesh.build(poses, { std::string(shared_skin) });
}

Mesh make_flare()
{
    constexpr float end = formats::flare_tip - 1.5f;
    Mesh mesh;
    mesh.tube({ -6, 0, 0 }, { end - 1.5f, 0, 0 }, 0.9f, 0.9f, M::red_paint, M::dark_steel, 8);
    mesh.tube({ end - 1.5f, 0, 0 }, { end, 0, 0 }, 0.7f, 0.5f, M::white_paint, M::glow_white, 8);
    return mesh;
}

} // namespace

void write_light_models(const Output& out)
{
    Mesh bulb;
    bulb.ball({ 0, 0, 0 }, glm::vec3(2), M::glow_white, 8, 6);
    write_model(out, path_of(formats::LightModel::bulb), bulb.build_still());
    write_model(out, path_of(formats::LightModel::swarm), bulb.build_still());
    write_model(out, path_of(formats::LightModel::spot), make_spot());
    write_model(out, path_of(formats::LightModel::flare), make_flare().build_still());
    write_shared_skin(out);
}

} // namespace vkpt::tools
