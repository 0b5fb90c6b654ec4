// SPDX-License-Identifier: GPL-2.0-or-later
// A clear sky and its sun: Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (1999).
#pragma once

#include "formats/image.hpp"

#include <cstddef>
#include <glm/vec3.hpp>

namespace vkpt {

class PhysicalSky {
public:
    // `to_sun`: unit; a sun below the horizon is taken for one at it. `turbidity`: 2 to 10.
    PhysicalSky(glm::vec3 to_sun, float turbidity);

    // Linear RGB, in thousands of candelas per square metre; below the horizon a darker copy of it. `direction`: unit.
    glm::vec3 radiance(glm::vec3 direction) const;
    // The sun's light on what faces it, in thousands of lux.
    glm::vec3 sun_irradiance() const;
    // The sky's light on level ground, in the same unit.
    glm::vec3 level_irradiance() const;
    glm::vec3 to_sun() const { return to_sun_; }
    float turbidity() const { return turbidity_; }

private:
    struct Perez {
        float a, b, c, d, e;
        float at(float cosine, float angle, float angle_cosine) const; // zenith and sun angles
    };

    glm::vec3 to_sun_;
    float turbidity_;
    float sun_angle_; // from the zenith
    Perez luminance_, x_, y_;
    glm::vec3 zenith_; // Y, x, y over the distributions' values there
};

// What a map's own sun, where that of the sky stands, counts as beside the sky: its light on what faces it, in
// thousands of lux. Near the horizon, and through haze, next to nothing of the sky's arrives, which no map means: it
// counts as if it stood 10 degrees high at least, and as half of the sky's light on level ground at least.
float light_of_map_sun(const PhysicalSky& sky);

// Side 0 to 5 of the sky as a texture (see direction_on_sky), the sun's disc with it; white stands for `white`.
formats::Image draw_sky_side(const PhysicalSky& sky, size_t side, int size, float white);

// The greatest component of the sky away from the sun's glare: what white may stand for in a texture.
float brightest_of_sky(const PhysicalSky& sky);

} // namespace vkpt
