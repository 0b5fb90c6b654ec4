// SPDX-License-Identifier: GPL-2.0-or-later
// The surface model of docs/renderer.md in double precision, written from its sources: a diffuse base under a GGX coat
// (Walter et al. 2007, Heitz 2014, Kelemen and Szirmay-Kalos 2001), or a GGX metal, mixed by `metallic`.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace vkpt::truth {

struct SurfacePoint {
    glm::dvec3 position, normal, geometric_normal; // normals on the viewer's side
    glm::dvec3 view; // towards the viewer, unit
    glm::dvec3 albedo;
    double roughness = 1, metallic = 0, specular = 1; // specular: share that is left of the coat
};

// BSDF times the cosine, for light from the unit direction `light`.
glm::dvec3 reflect_light(const SurfacePoint& surface, glm::dvec3 light);

struct ScatteredRay {
    glm::dvec3 direction { 0 };
    double pdf = 0; // per solid angle; 0: nothing goes on
};
// Half the rays by the cosine, half by the distribution of the coat's normals. `xi`: three random numbers in 0..1.
ScatteredRay scatter(const SurfacePoint& surface, glm::dvec3 xi);

// A direction around an axis, given as tangent, bitangent, axis.
glm::dvec3 turn_to(glm::dvec3 axis, glm::dvec3 local);

} // namespace vkpt::truth
