// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/map_lights.hpp"

#include <algorithm>
#include <utility>

namespace vkpt {

MapLights::MapLights(const World& world, size_t sun_count)
    : world_(world)
{
    constexpr uint32_t none = UINT32_MAX;
    const formats::BspModel& model = world.bsp.models[0];
    light_of_emitter_.assign(world.models[0].emitters.size(), none);
    for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++) {
        bool is_new = true;
        for (const FaceTriangle& triangle : world.faces.of(face)) {
            if (triangle.emitter < 0)
                continue;
            if (std::exchange(is_new, false))
                faces_.push_back(int64_t(face));
            light_of_emitter_[size_t(triangle.emitter)] = uint32_t(faces_.size() - 1);
        }
    }
    for (uint32_t& light : light_of_emitter_)
        if (light == none) {
            light = uint32_t(faces_.size());
            faces_.push_back(-1);
        }
    muted_.assign(faces_.size() + sun_count, false);
}

const std::string& MapLights::texture_of(uint32_t light) const
{
    return world_.bsp.texinfos[world_.bsp.faces[size_t(faces_[light])].texinfo].texture;
}

size_t MapLights::muted_count() const { return size_t(std::ranges::count(muted_, true)); }

void MapLights::mute(std::vector<bool> lights)
{
    muted_ = std::move(lights);
    version_++;
    shown_ = nullptr;
    if (muted_count() == 0)
        return;
    const MapGeometry& geometry = world_.models[0];
    auto shown = std::make_shared<ShownLights>(ShownLights { geometry.emitters, geometry.triangles, version_ });
    for (size_t i = 0; i < shown->emitters.size(); i++)
        if (muted_[light_of_emitter_[i]])
            shown->emitters[i].lightstyle = lightstyle_none;
    for (shared::Triangle& triangle : shown->triangles)
        if (triangle.face > 0) {
            const auto of_face = world_.faces.of(size_t(triangle.face - 1));
            const auto lit = std::ranges::find_if(of_face, [](const FaceTriangle& t) { return t.emitter >= 0; });
            if (lit != of_face.end() && muted_[light_of_emitter_[size_t(lit->emitter)]])
                triangle.lightstyle = lightstyle_none;
        }
    shown_ = std::move(shown);
}

} // namespace vkpt
