// SPDX-License-Identifier: GPL-2.0-or-later
// Quake II's compiled map, BSP version 38, and its extended form with wider fields, QBSP: read whole, every index
// checked once, so that users need not check again. In memory both have the wide fields. Space: Quake units (inches,
// roughly), x east, y north, z up.
#pragma once

#include "formats/byte_reader.hpp"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace formats {

// texinfo flags
enum SurfaceFlags : uint32_t {
    SURF_LIGHT = 0x1, // emits `value`
    SURF_SLICK = 0x2,
    SURF_SKY = 0x4,
    SURF_WARP = 0x8, // liquid surface, texture turbulence
    SURF_TRANS33 = 0x10,
    SURF_TRANS66 = 0x20,
    SURF_FLOWING = 0x40,
    SURF_NODRAW = 0x80,
    SURF_HINT = 0x100,
    SURF_SKIP = 0x200,
    SURF_ALPHATEST = 0x02000000,
};

// leaf and brush contents
enum ContentFlags : uint32_t {
    CONTENTS_SOLID = 0x1,
    CONTENTS_WINDOW = 0x2,
    CONTENTS_AUX = 0x4,
    CONTENTS_LAVA = 0x8,
    CONTENTS_SLIME = 0x10,
    CONTENTS_WATER = 0x20,
    CONTENTS_MIST = 0x40,
    CONTENTS_AREAPORTAL = 0x8000,
    CONTENTS_PLAYERCLIP = 0x10000,
    CONTENTS_MONSTERCLIP = 0x20000,
    CONTENTS_DETAIL = 0x8000000,
    CONTENTS_TRANSLUCENT = 0x10000000,
    CONTENTS_LADDER = 0x20000000,
};

enum class BspFormat {
    ibsp, // Quake II's own: most indices and counts have 16 bits, so that no list is longer than 65,536
    qbsp, // the same lumps and version with 32 bits instead, and bounds that are floats: ericw-tools' -qbism, Q2RTX
};

// Records as they lie on disk in a QBSP (little-endian, packed).
struct BspPlane {
    glm::vec3 normal;
    float dist;
    int32_t type; // 0..2 axial x, y, z; 3..5 nearest axis
};
struct BspNode {
    int32_t plane;
    int32_t children[2]; // >= 0 node, < 0 leaf -(index + 1)
    float mins[3], maxs[3];
    uint32_t first_face, face_count;
};
struct BspLeaf {
    uint32_t contents;
    int32_t cluster; // -1: solid, no PVS row
    int32_t area;
    float mins[3], maxs[3];
    uint32_t first_leaf_face, leaf_face_count;
    uint32_t first_leaf_brush, leaf_brush_count;
};
struct BspFace {
    uint32_t plane;
    uint32_t side; // 1: the face looks against its plane's normal
    int32_t first_edge;
    uint32_t edge_count;
    uint32_t texinfo;
    uint8_t styles[4]; // lightstyle per lightmap, 255 none
    int32_t light_offset; // bytes into `lighting`, -1 none
};
struct BspEdge {
    uint32_t vertices[2];
};
struct BspModel { // 0 is the world; the rest are brush models "*1", "*2", ...
    glm::vec3 mins, maxs, origin;
    int32_t head_node;
    int32_t first_face, face_count;
};
struct BspBrush {
    int32_t first_side, side_count;
    uint32_t contents;
};
struct BspBrushSide {
    uint32_t plane;
    int32_t texinfo; // -1 none
};
struct BspArea {
    int32_t area_portal_count, first_area_portal;
};
struct BspAreaPortal {
    int32_t portal, other_area;
};
static_assert(sizeof(BspPlane) == 20 && sizeof(BspNode) == 44 && sizeof(BspLeaf) == 52 && sizeof(BspFace) == 28);
static_assert(sizeof(BspEdge) == 8 && sizeof(BspModel) == 48 && sizeof(BspBrush) == 12 && sizeof(BspBrushSide) == 8);

struct BspTexinfo {
    glm::vec3 s_axis;
    float s_offset; // texels: s = dot(p, s_axis) + s_offset
    glm::vec3 t_axis;
    float t_offset;
    uint32_t flags; // SurfaceFlags
    int32_t value; // light emission where SURF_LIGHT
    std::string texture; // name without folder and ending, e.g. "e1u1/metal1_1"
    int32_t next; // next texinfo of the animation chain, -1 none
};

// One bit per cluster.
class ClusterSet {
public:
    ClusterSet() = default;
    explicit ClusterSet(size_t cluster_count)
        : bits_((cluster_count + 7) / 8)
        , count_(cluster_count)
    {
    }
    size_t size() const { return count_; }
    bool contains(int cluster) const
    {
        return cluster >= 0 && size_t(cluster) < count_ && (bits_[size_t(cluster) >> 3] >> (cluster & 7) & 1);
    }
    void insert(int cluster) { bits_[size_t(cluster) >> 3] |= uint8_t(1 << (cluster & 7)); }
    void merge(const ClusterSet& other)
    {
        for (size_t i = 0; i < bits_.size(); i++)
            bits_[i] |= other.bits_[i];
    }
    std::vector<uint8_t>& bytes() { return bits_; }
    const std::vector<uint8_t>& bytes() const { return bits_; }

private:
    std::vector<uint8_t> bits_;
    size_t count_ = 0;
};

struct Bsp {
    std::string name; // for messages
    BspFormat format = BspFormat::ibsp; // of the file that it was read from, or is written to
    size_t file_size = 0; // bytes that it was read from; 0: made in memory
    std::string entity_text;
    std::vector<BspPlane> planes;
    std::vector<glm::vec3> vertices;
    std::vector<uint8_t> visibility; // the raw lump; use pvs()
    std::vector<BspNode> nodes;
    std::vector<BspTexinfo> texinfos;
    std::vector<BspFace> faces;
    std::vector<uint8_t> lighting; // RGB8 lightmap samples
    std::vector<BspLeaf> leaves;
    std::vector<uint32_t> leaf_faces, leaf_brushes;
    std::vector<BspEdge> edges;
    std::vector<int32_t> surface_edges; // < 0: edge -n reversed
    std::vector<BspModel> models;
    std::vector<BspBrush> brushes;
    std::vector<BspBrushSide> brush_sides;
    std::vector<BspArea> areas;
    std::vector<BspAreaPortal> area_portals;
    int cluster_count = 0; // 0: the map was compiled without visibility; then everything sees everything

    // The face's outline, counter-clockwise seen from its front. (On disk it is clockwise.)
    std::vector<glm::vec3> face_polygon(size_t face) const;
    glm::vec3 face_normal(size_t face) const;
    // Texel coordinates (not divided by the picture's size).
    glm::vec2 texture_coordinates(const BspTexinfo& texinfo, glm::vec3 p) const;
    // Lightmap of a face: size in luxels (16 units each) and the lowest luxel's texel coordinates. Zero size: none.
    struct LightmapExtent {
        glm::ivec2 size { 0 };
        glm::vec2 min_st { 0 };
    };
    LightmapExtent lightmap_extent(size_t face) const;
    size_t find_leaf(glm::vec3 p, int head_node = 0) const;
    int find_cluster(glm::vec3 p) const; // -1 in solid
    // What `cluster` can see (decompressed; always contains itself). cluster -1: an empty set. Without visibility: the
    // set holds, and is as long as, all clusters that leaves name, which are then not limited by cluster_count.
    ClusterSet pvs(int cluster) const;
};

// Throws FormatError naming lump, offset and reason. A small map must not cost much to use: lumps that overlap, surface
// edges, leaf faces and faces that several records share, faces of more than 64 edges and endless animations are
// refused, though they could be read. Two things are mended instead: a face whose light samples are not in the file
// gets light_offset -1, and a texinfo chain that never returns to its start is cut where it enters the ring.
Bsp read_bsp(Bytes file, std::string_view name);
// The inverse, for the map compiler and the tests, in the map's own format. `visibility` and `lighting` are written as
// they stand. Throws std::invalid_argument with lump and record where a number does not fit into the format's field.
std::vector<std::byte> write_bsp(const Bsp& bsp);

} // namespace formats
