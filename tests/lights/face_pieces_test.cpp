// SPDX-License-Identifier: GPL-2.0-or-later
// Faces of which a part shines: the pieces cover the face, without cracks, and send the light that the whole face
// would.
#include "common/colour.hpp"
#include "map_emitters.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <tuple>

namespace vkpt::test {
namespace {

using glm::vec2, glm::vec3;

constexpr uint16_t lamp_texinfo = 1; // SURF_LIGHT 100
const std::vector<BrightPart> middle_lamp { { vec2(0.25f, 0.25f), vec2(0.75f, 0.5f), vec3(1, 0.5f, 0.25f) } };

struct Panel {
    formats::Bsp bsp = make_cell_map(1, { true });
    size_t face = 0;

    Panel(const std::vector<vec3>& outline, vec2 offset, float turn = 0)
    {
        face = add_face(bsp, outline, vec3(0, 0, 1), lamp_texinfo);
        formats::BspTexinfo& texinfo = bsp.texinfos[lamp_texinfo];
        texinfo.s_axis = vec3(std::cos(turn), std::sin(turn), 0);
        texinfo.t_axis = vec3(-std::sin(turn), std::cos(turn), 0);
        texinfo.s_offset = offset.x;
        texinfo.t_offset = offset.y;
        texinfo.next = -1;
    }
    std::vector<FacePiece> cut(const std::vector<BrightPart>& parts = middle_lamp, int size = 64) const
    {
        WorkLimit work = limit_of_pieces(bsp);
        return cut_face(bsp, face, parts, glm::ivec2(size), work);
    }
};

std::vector<vec3> make_square(float side) { return { { 0, 0, 0 }, { side, 0, 0 }, { side, side, 0 }, { 0, side, 0 } }; }

float area_of(const std::vector<FacePiece>& pieces, bool shining)
{
    float sum = 0;
    for (const FacePiece& piece : pieces)
        if ((piece.part != FacePiece::dark) == shining)
            sum += measure_area(piece.outline);
    return sum;
}

TEST(FacePieces, CoverTheFace)
{
    for (const float side : { 64.0f, 128.0f, 200.0f })
        for (const float turn : { 0.0f, 0.5f })
            for (const vec2 offset : { vec2(0), vec2(17.3f, -40.1f) }) {
                const Panel panel(make_square(side), offset, turn);
                const std::vector<FacePiece> pieces = panel.cut();
                ASSERT_FALSE(pieces.empty());
                EXPECT_NEAR(area_of(pieces, true) + area_of(pieces, false), side * side, 0.3f) << side << " " << turn;
                for (const FacePiece& piece : pieces)
                    for (const vec3& corner : piece.outline) {
                        EXPECT_EQ(corner.z, 0);
                        // In texels of its tile, every corner of what shines lies in the part.
                        const vec2 at = glm::fract(
                            panel.bsp.texture_coordinates(panel.bsp.texinfos[lamp_texinfo], corner) / 64.0f + 1e-4f);
                        if (piece.part != FacePiece::dark) {
                            EXPECT_GT(at.x, 0.249f);
                            EXPECT_LT(at.x, 0.751f);
                            EXPECT_GT(at.y, 0.249f);
                            EXPECT_LT(at.y, 0.501f);
                        }
                    }
            }
    EXPECT_NEAR(area_of(Panel(make_square(128), vec2(0)).cut(), true), 4 * 32 * 16, 0.1f);
}

// Every edge of a triangle inside the face is the edge of another one, with the very same corners.
TEST(FacePieces, HaveNoCracks)
{
    for (const float turn : { 0.0f, 0.3f, 0.785398f }) {
        const Panel panel(make_square(150), vec2(5.5f, 31), turn);
        std::map<std::tuple<float, float, float, float>, int> edges;
        size_t count = 0;
        for (const FacePiece& piece : panel.cut())
            for (const auto& t : triangulate(piece.outline, vec3(0, 0, 1)))
                for (size_t i = 0; i < 3; i++) {
                    const vec3 a = piece.outline[t[i]], b = piece.outline[t[(i + 1) % 3]];
                    edges[{ a.x, a.y, b.x, b.y }]++;
                    count++;
                }
        EXPECT_GT(count, 60u);
        for (const auto& [edge, times] : edges) {
            const auto [ax, ay, bx, by] = edge;
            EXPECT_EQ(times, 1);
            const auto on = [](float value) { return std::abs(value) < 1e-3f || std::abs(value - 150) < 1e-3f; };
            const bool is_border = (on(ax) && std::abs(ax - bx) < 1e-3f) || (on(ay) && std::abs(ay - by) < 1e-3f);
            if (!is_border) {
                EXPECT_EQ(edges.count({ bx, by, ax, ay }), 1u)
                    << turn << ": " << ax << ", " << ay << " to " << bx << ", " << by;
            }
        }
    }
}

TEST(FacePieces, AreNoneWhereTheWholeFaceShines)
{
    EXPECT_TRUE(Panel(make_square(64), vec2(0)).cut({}).empty());
    EXPECT_TRUE(Panel(make_square(10), vec2(0)).cut().empty()); // shows nothing but the dark corner
    EXPECT_TRUE(Panel(make_square(4000), vec2(0)).cut().empty()); // thousands of lamps
    Panel moving(make_square(64), vec2(0));
    moving.bsp.texinfos[lamp_texinfo].flags |= formats::SURF_FLOWING;
    EXPECT_TRUE(moving.cut().empty());
    Panel broken(make_square(64), vec2(0));
    broken.bsp.texinfos[lamp_texinfo].s_axis = vec3(NAN);
    EXPECT_TRUE(broken.cut().empty());
}

TEST(FacePieces, SendWhatTheWholeFaceWould)
{
    const Panel panel(make_square(100), vec2(3, 9));
    const FaceTexture whole = make_texture(vec3(0.4f, 0.2f, 0.1f));
    FaceTexture parted = whole;
    parted.parts = middle_lamp;
    const auto emit = [&](const FaceTexture& texture) {
        const MapFaces faces(panel.bsp, texture);
        return emitters_of_face(faces.source(), panel.face, faces.triangles.of(panel.face));
    };
    const auto power = [&](const FaceTexture& texture) {
        float sum = 0;
        for (const shared::Emitter& e : emit(texture)) {
            EXPECT_GT(e.area, 0);
            sum += e.area * luminance(e.radiance);
        }
        return sum;
    };
    EXPECT_GT(power(whole), 0);
    EXPECT_NEAR(power(parted), power(whole), 1e-4f * power(whole));
    const auto emitters = emit(parted);
    MapFaces faces(panel.bsp, parted);
    const std::span<FaceTriangle> triangles = faces.triangles.of(panel.face);
    number_emitters(triangles, 7);
    size_t next = 0;
    for (const FaceTriangle& t : triangles)
        if (t.part != FacePiece::dark) {
            ASSERT_LT(next, emitters.size());
            EXPECT_EQ(emitters[next].p0, t.corners[0]);
            EXPECT_EQ(t.emitter, 7 + int(next++));
        } else
            EXPECT_EQ(t.emitter, shared::EMITTER_SAMPLED_APART);
    EXPECT_EQ(next, emitters.size());
    EXPECT_LT(next, triangles.size());
    EXPECT_NEAR(emitters[0].radiance.y, 0.5f * emitters[0].radiance.x, 1e-5f * emitters[0].radiance.x);
}

} // namespace
} // namespace vkpt::test
