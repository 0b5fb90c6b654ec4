// SPDX-License-Identifier: GPL-2.0-or-later
// A map's lights as people see them: a lamp is a face with all its emitters, any other light is one emitter; the suns
// come last. And those that somebody has muted, to see what the others do.
#pragma once

#include "ref_vkpt/scene/world.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vkpt {

// What takes the place of a map's emitters and triangles while some of its lights are muted: the same, but that neither
// shines.
struct ShownLights {
    std::vector<shared::Emitter> emitters;
    std::vector<shared::Triangle> triangles;
    uint32_t version = 0; // another number after each change
};

class MapLights {
public:
    // `world` has to live as long. `sun_count`: of the map and of its sky.
    MapLights(const World& world, size_t sun_count);

    size_t light_count() const { return muted_.size(); }
    // Of the world model's emitters.
    uint32_t light_of(uint32_t emitter) const { return light_of_emitter_[emitter]; }
    bool is_lamp(uint32_t light) const { return light < faces_.size() && faces_[light] >= 0; }
    size_t sun_count() const { return light_count() - faces_.size(); }
    uint32_t light_of_sun(size_t sun) const { return uint32_t(faces_.size() + sun); }
    bool is_sun_muted(size_t sun) const { return sun < sun_count() && muted_[light_of_sun(sun)]; }
    // Of a lamp.
    const std::string& texture_of(uint32_t light) const;

    // Muted are these lights, and no others.
    void mute(std::vector<bool> lights);
    const std::vector<bool>& muted() const { return muted_; }
    size_t muted_count() const;
    // nullptr: none is muted, the world's own are shown.
    const std::shared_ptr<const ShownLights>& shown() const { return shown_; }

private:
    const World& world_;
    std::vector<int64_t> faces_; // per light but the suns; -1: it is no lamp
    std::vector<uint32_t> light_of_emitter_;
    std::vector<bool> muted_; // per light
    std::shared_ptr<const ShownLights> shown_;
    uint32_t version_ = 0;
};

} // namespace vkpt
