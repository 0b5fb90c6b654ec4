// SPDX-License-Identifier: GPL-2.0-or-later
// The map's brushes made solid: planes, side polygons, contents, texinfos, and the bevel planes that box traces need.
#pragma once

#include "formats/bsp.hpp"
#include "tools/map_compiler/geometry.hpp"
#include "tools/map_compiler/map_source.hpp"
#include "tools/map_compiler/textures.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vkpt::tools {

// The contents that are seen: SOLID .. MIST. Of several at one place, the lowest bit wins (solid over window over
// water).
inline constexpr uint32_t visible_contents_mask = 0x7f;
inline constexpr uint32_t clip_contents = formats::CONTENTS_PLAYERCLIP | formats::CONTENTS_MONSTERCLIP;

// The bit that decides what is seen between or in `contents`; 0: nothing.
inline uint32_t visible_contents(uint32_t contents)
{
    contents &= visible_contents_mask;
    return contents & (~contents + 1);
}

struct BrushSide {
    int plane = 0; // looks out of the brush
    int texinfo = 0; // always valid in the file: the engine indexes with it unchecked
    uint32_t contents = 0, flags = 0;
    Winding winding; // empty for bevels and for sides that other sides cut away
    int line = 0; // in the source; bevels have none
    bool bevel = false; // for box traces only
    bool divides = true; // may become a node of the tree and a face
    bool visible = false; // between places of different contents inside the map
};

struct Brush {
    std::vector<BrushSide> sides;
    uint32_t contents = 0;
    int line = 0;
    int area_portal = 0; // number of its func_areaportal, 0 none
    Bounds bounds;
    bool is_detail() const { return contents & formats::CONTENTS_DETAIL; }
};

// The world (0) or one brush entity ("*1", "*2", ...).
struct BrushModel {
    int entity = 0;
    dvec3 origin { 0 }; // of the origin brush; the brushes are moved so that it is their zero
    std::vector<Brush> brushes;
};

struct SourceMap {
    MapSource source;
    PlaneSet planes;
    std::vector<formats::BspTexinfo> texinfos;
    std::vector<dvec3> light_colour, reflectivity; // per texinfo, see TextureInfo
    std::vector<BrushModel> models;
    int area_portal_count = 0;

    std::string entity_text() const;
};

using WarningSink = std::function<void(const std::string&)>;

// Throws MapError naming the brush's line.
SourceMap build_world(MapSource source, TextureLibrary& textures, const WarningSink& warn);

} // namespace vkpt::tools
