// SPDX-License-Identifier: GPL-2.0-or-later
// What is seen: polygons from the portals, merged, cut to the lightmap's limit, and made free of t-junctions.
#pragma once

#include "tools/map_compiler/tree.hpp"

#include <cstdint>

namespace vkpt::tools {

// Lightmaps have at most 16 x 16 luxels of 16 texels: a face may span this many texels.
inline constexpr double max_face_texels = 240;

struct Face {
    int plane = 0; // looks out of the surface
    int texinfo = 0;
    int node = 0;
    Winding winding;
    int line = 0; // of the side in the source
    uint32_t contents = 0; // of the leaf that it faces
    std::vector<int> replaced_by; // when merged or cut; else empty and the face is written
};

struct FaceSet {
    std::vector<Face> faces;
    // The faces that are written in place of `face`.
    void collect(int face, std::vector<int>& result) const;
};

// Fills the portals' and the nodes' face lists of the tree.
FaceSet make_faces(Tree& tree, const SourceMap& world);

} // namespace vkpt::tools
