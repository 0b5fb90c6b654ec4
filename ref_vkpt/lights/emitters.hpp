// SPDX-License-Identifier: GPL-2.0-or-later
// What emits light in a map: faces of the world and of brush models, sky faces, point light entities.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/face_pieces.hpp"
#include "shaders/shared/scene.h"

#include <array>
#include <cstdint>
#include <functional>
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
// - sky: a classic sky is bright in the lightmaps where its picture is not; measured with the stand-in for a missing
//   one.
// docs/calibration.md has the figures.
struct EmissionScales {
    float face = 0.0095f; // radiance = face * texinfo value * normalised picture colour * its strength
    float point = 0.0011f; // radiant intensity of a point light = point * its "light" value cubed
    float sky = 3.1f; // radiance = sky * sky picture (sky faces that are not SURF_LIGHT; others: as faces)
    float glow = 2; // radiance of glowing parts without a light value = glow * picture: as bright as lightmaps get
    float point_light_radius = 4; // of the spheres that stand for point lights, units; less where walls are nearer
};

// What a picture lends to the light that its surface emits.
struct PictureColour {
    PictureColour(glm::vec3 average_, float strength_ = 1)
        : average(average_)
        , strength(strength_)
    {
    }
    glm::vec3 average; // linear RGB 0..1
    float strength; // of the light: missing_picture_strength where `average` is that of a stand-in
    std::vector<BrightPart> parts; // where it shines; none: all over
    glm::ivec2 size { 64 }; // texels of texinfo space
    bool glows = false; // its parts shine on faces without a light value, too
};
// The classic light compiler counts a missing picture as half as bright as any that is there.
inline constexpr float missing_picture_strength = 0.5f;
// Asked for by texinfo texture name.
using AverageColour = std::function<PictureColour(const std::string& texture)>;

struct StaticEmitters {
    // Spatially coherent: in the order of BSP leaves, so that strided subsets are representative.
    std::vector<shared::Emitter> emitters;
    // Where the shining triangles of face f went: emitters[first_of_face[f] .. first_of_face[f] + count_of_face[f]), in
    // the order of triangles_of_face; -1: none.
    std::vector<int32_t> first_of_face;
    std::vector<uint32_t> count_of_face;
    std::vector<glm::vec3> face_emission; // what Material::emission has to be for that face's texinfo (per texinfo)
    std::vector<std::string> messages; // what could not be used, by name
};

// A face's outline where it is drawn, used for geometry and emitters alike: Bsp::face_polygon, but for liquids that
// stand `liquid_lift` in front of their plane. The surface of a liquid is two faces in one plane that look away from
// each other; apart, a ray meets the one whose front it sees, and no chance of rounding decides which. Less than the
// distance from which rays leave a surface (offset_ray_origin in shaders/lib/surfaces.glsl): what passes one of the two
// has passed both.
inline constexpr float liquid_lift = 1.0f / 128;
std::vector<glm::vec3> face_outline(const formats::Bsp& bsp, size_t face);

// Cuts a convex outline: indices into it, front as in Triangle, `normal` being the face's. All corners are used, also
// those on straight edges (neighbours may end there), as far as triangles with an area allow it. Slivers of zero area
// are left out.
std::vector<std::array<uint32_t, 3>> triangulate(const std::vector<glm::vec3>& outline, glm::vec3 normal);

// Every face's triangles, used for geometry and emitters alike. Where the face emits and its picture has bright parts,
// those emit all of the face's light, in their colours. `work`: see cut_face.
struct FaceTriangle {
    static constexpr int whole = -2; // the face is in one piece
    std::array<glm::vec3, 3> corners;
    int part; // whose light: an index of the picture's parts, FacePiece::dark or `whole`
};
std::vector<FaceTriangle> triangles_of_face(
    const formats::Bsp& bsp, size_t face, const PictureColour& picture, WorkLimit& work);

// Emitters of the world model (faces of models[0], and entities). Brush models: emitters_of_brush_model, model space.
// Throws formats::FormatError where that takes far more work than a map of its size may.
StaticEmitters extract_emitters(const formats::Bsp& bsp, const AverageColour& colour, const EmissionScales& scales);
std::vector<shared::Emitter> emitters_of_brush_model(
    const formats::Bsp& bsp, size_t model, const AverageColour& colour, const EmissionScales& scales);

// Whether a face without a light value shines where its picture's bright parts are.
bool is_glowing(const formats::BspTexinfo& texinfo, const PictureColour& picture);

// What a switched or flickering lamp goes with: the face's first lightstyle that is not the steady one. 0: none is.
uint32_t face_lightstyle(const formats::BspFace& face);

// Average radiance of a SURF_LIGHT texinfo's front, 0 of others; of an animation's frame that is brightest.
glm::vec3 frame_radiance(
    const formats::Bsp& bsp, uint32_t texinfo, const AverageColour& colour, const EmissionScales& scales);
glm::vec3 face_radiance(
    const formats::Bsp& bsp, uint32_t texinfo, const AverageColour& colour, const EmissionScales& scales);

// The shining triangles of one face as emitters, in the order of triangles_of_face; empty: the face emits nothing.
std::vector<shared::Emitter> emitters_of_face(
    const formats::Bsp& bsp, size_t face, const AverageColour& colour, const EmissionScales& scales, WorkLimit& work);

// The engine's dynamic light: it adds colour * (intensity - distance), in lightmap units, to what is nearer than
// `intensity`. The sphere's inverse-square light, faded to nothing there, equals that at half the distance. Negative
// colours (lights that darken) become 0.
shared::Emitter make_dynamic_light(glm::vec3 origin, glm::vec3 colour, float intensity, float radius = 4);

// The spheres of all point light entities, in the order of the entities (point_lights.cpp).
std::vector<shared::Emitter> extract_point_lights(
    const formats::Bsp& bsp, const EmissionScales& scales, std::vector<std::string>& messages);

} // namespace vkpt
