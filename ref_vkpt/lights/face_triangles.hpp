// SPDX-License-Identifier: GPL-2.0-or-later
// A map's faces as triangles. Each face is cut once; geometry, emitters and sampler tables read the same triangles.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/face_pieces.hpp"
#include "shaders/shared/scene.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace vkpt {

// What geometry and emitters have to know of a texinfo's texture.
// The maps that go with a texture.
struct TextureMaps {
    struct Map {
        uint32_t slot = 0, packed_size = 0x10001; // see Texture; slot 0: none
    };
    Map normals, emissive;
    bool has_metalness = false; // in the normal map's alpha
    bool texture_has_roughness = false; // in the texture's own alpha, as there is a normal map
};

struct FaceTexture {
    uint32_t slot = 0, packed_size = 0x10001; // see Texture
    glm::ivec2 size { 64 }; // texels of texinfo space
    glm::vec3 average { 0.5f }; // linear RGB 0..1
    bool missing = false; // a stand-in
    bool has_holes = false; // whatever the map's flags say
    std::vector<BrightPart> parts; // where it shines; none: all over
    bool glows = false; // its parts shine on faces without a light value, too
    TextureMaps maps; // with an emissive one, `average` and `parts` are that one's, and so is the texture that shines
    float emissive_factor = 1; // times what shines by it
    float default_radiance = 1; // times what shines without the map's light value
    bool takes_light_value = true; // the map's; else lamps shine as bright as the texture glows without one
    bool takes_lightstyles = true; // else lamps are steady
    bool is_sky = false, is_invisible = false; // whatever the map's flags say
    uint32_t medium = shared::MEDIUM_NONE; // MEDIUM_* of liquids, whatever the map says; MEDIUM_NONE: as it says
};

// Surfaces of liquids and of other things that are not solid are two faces in one plane that look away from each other
// (back_to_back.hpp). So far in front of their plane they stand apart: a ray meets the one whose front it sees, and no
// chance of rounding decides which. Less than the distance from which rays leave a surface (offset_ray_origin in
// shaders/lib/surfaces.glsl): what passes one of the two has passed both.
inline constexpr float side_lift = 1.0f / 128;

// The mean of a face's corners, in its plane.
glm::vec3 face_centre(const formats::Bsp& bsp, size_t face);

// Cuts a convex outline: indices into it, front as in Triangle, `normal` being the face's. All corners are used, also
// those on straight edges (neighbours may end there), as far as triangles with an area allow it. Slivers of zero area
// are left out.
std::vector<std::array<uint32_t, 3>> triangulate(const std::vector<glm::vec3>& outline, glm::vec3 normal);

struct FaceTriangle {
    static constexpr int whole = -2; // the face is in one piece
    std::array<glm::vec3, 3> corners;
    int part; // whose light: an index of the texture's parts, FacePiece::dark or `whole`
    int emitter = shared::EMITTER_UNLISTED; // as Triangle::emitter: set by extract_emitters
};

// Not those of faces that are neither drawn nor emit. Faces that stand back to back are lifted by side_lift. Where a
// face emits and its texture has bright parts, it is cut along them: those emit all of the face's light, in their
// colours.
class FaceTriangles {
public:
    FaceTriangles() = default;
    // `textures`: per texinfo. Throws formats::FormatError where that takes far more work than a map of its size may.
    FaceTriangles(const formats::Bsp& bsp, std::span<const FaceTexture> textures);

    std::span<FaceTriangle> of(size_t face)
    {
        return std::span(triangles_).subspan(first_[face], first_[face + 1] - first_[face]);
    }
    std::span<const FaceTriangle> of(size_t face) const
    {
        return std::span(triangles_).subspan(first_[face], first_[face + 1] - first_[face]);
    }

private:
    std::vector<FaceTriangle> triangles_;
    std::vector<uint32_t> first_; // face f has [first_[f], first_[f + 1])
};

bool is_drawn(const formats::BspTexinfo& texinfo);

} // namespace vkpt
