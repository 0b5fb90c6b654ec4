// SPDX-License-Identifier: GPL-2.0-or-later
// What emits light in a map: faces of the world and of brush models, sky faces, point light entities.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/face_triangles.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vkpt {

// How the map compiler's numbers become radiance. Measured against the baked lightmaps of real maps:
// tools/calibrate_light.
//
// What the classic light compiler computes, in lightmap units (our unit: a white diffuse surface under lightmap value
// 128 has radiance 1, so irradiance / pi = value / 128), and what the measurement made of it:
// - face: a patch of area A adds 0.4 * texinfo value * colour * A * cos * cos' / d^2. A patch of radiance L adds
//   L * A * cos * cos' / (pi d^2). Equal for L = 0.4 pi / 128 * value = 0.0098 * value.
// - point: a light adds (light - d) * cos: linear, nothing beyond d = light. A light of intensity I adds
//   I * cos / (pi d^2). Equal at distance d for I = pi d^2 (light - d) / 128. The value is the light's reach, so that d
//   goes with it: at a quarter of the reach, I = 0.00115 * light^3. Measured: 0.0011; a map lit by lights of 800 and
//   one lit by lights of 120 to 350 ask for the same factor within 2, which no factor to the plain value does.
// - sky: a classic sky is bright in the lightmaps where its texture is not; measured with the stand-in for a missing
//   one.
// docs/calibration.md has the figures.
struct EmissionScales {
    float face = 0.0095f; // radiance = face * texinfo value * normalised texture colour * its strength
    float point = 0.0011f; // radiant intensity of a point light = point * its "light" value cubed
    float sky = 3.1f; // radiance = sky * sky texture (sky faces that are not SURF_LIGHT; others: as faces)
    float glow = 2; // radiance of glowing parts without a light value = glow * texture: as bright as lightmaps get
    float point_light_radius = 4; // of the spheres that stand for point lights, units; less where walls are nearer
};

// What emission depends on.
struct EmissionSource {
    const formats::Bsp& bsp;
    std::span<const FaceTexture> textures; // per texinfo
    EmissionScales scales {};
};

struct StaticEmitters {
    // Spatially coherent: in the order of BSP leaves, so that strided subsets are representative.
    std::vector<shared::Emitter> emitters;
    // Where the shining triangles of face f went: emitters[first_of_face[f] .. first_of_face[f] + count_of_face[f]), in
    // the order of its triangles; -1: none.
    std::vector<int32_t> first_of_face;
    std::vector<uint32_t> count_of_face;
    std::vector<glm::vec3> face_emission; // what Material::emission has to be for that face's texinfo (per texinfo)
    std::vector<std::string> messages; // what could not be used, by name
};

// Emitters of the world model (faces of models[0], and entities), and which triangle is which emitter.
// Throws formats::FormatError where that takes far more work than a map of its size may.
StaticEmitters extract_emitters(const EmissionSource& source, FaceTriangles& faces);

// The shining triangles of one face as emitters, in the order of its triangles; empty: the face emits nothing.
std::vector<shared::Emitter> emitters_of_face(
    const EmissionSource& source, size_t face, std::span<const FaceTriangle> triangles);
// Their place among the emitters of the face's model: -1: another light sends what the face is seen to send.
void number_emitters(std::span<FaceTriangle> triangles, int first_emitter);

// SURF_LIGHT with a value, and drawn.
bool has_light_value(const formats::BspTexinfo& texinfo);
// Whether a face without a light value shines where its texture's bright parts are.
bool is_glowing(const formats::BspTexinfo& texinfo, const FaceTexture& texture);

// What a switched or flickering lamp goes with: the face's first lightstyle that is not the steady one. 0: none is, or
// the texture takes none.
uint32_t face_lightstyle(const formats::BspFace& face, const FaceTexture& texture);

// Average radiance of a SURF_LIGHT texinfo's front, 0 of others; of an animation's frame that is brightest.
glm::vec3 frame_radiance(const EmissionSource& source, uint32_t texinfo);
glm::vec3 face_radiance(const EmissionSource& source, uint32_t texinfo);

// The engine's dynamic light: it adds colour * (intensity - distance), in lightmap units, to what is nearer than
// `intensity`. The sphere's inverse-square light, faded to nothing there, equals that at half the distance. Negative
// colours (lights that darken) become 0.
shared::Emitter make_dynamic_light(glm::vec3 origin, glm::vec3 colour, float intensity, float radius = 4);

// The spheres of all point light entities, in the order of the entities (point_lights.cpp).
std::vector<shared::Emitter> extract_point_lights(
    const formats::Bsp& bsp, const EmissionScales& scales, std::vector<std::string>& messages);

} // namespace vkpt
