// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_disk.hpp"
#include "formats/byte_writer.hpp"

namespace formats {

using namespace bsp_disk;

namespace {

TexinfoRecord to_record(const BspTexinfo& texinfo)
{
    if (texinfo.texture.size() >= texture_name_size)
        throw std::invalid_argument("texture name \"" + texinfo.texture + "\" is longer than 31 bytes");
    TexinfoRecord record { texinfo.s_axis, texinfo.s_offset, texinfo.t_axis, texinfo.t_offset, texinfo.flags,
        texinfo.value, {}, texinfo.next };
    std::copy(texinfo.texture.begin(), texinfo.texture.end(), record.texture.begin());
    return record;
}

class LumpWriter {
public:
    LumpWriter()
    {
        file_.write(ident);
        file_.write(version);
        file_.write(directory_);
    }

    template <class T> void add(Lump lump, const std::vector<T>& items)
    {
        file_.align(4);
        directory_[lump] = { uint32_t(file_.position()), uint32_t(items.size() * sizeof(T)) };
        file_.write_array(std::span<const T>(items));
    }

    std::vector<std::byte> finish()
    {
        file_.align(4);
        file_.patch(header_size - sizeof(Directory), directory_);
        return file_.take();
    }

private:
    ByteWriter file_;
    Directory directory_ {};
};

} // namespace

std::vector<std::byte> write_bsp(const Bsp& bsp)
{
    std::vector<char> entity_text(bsp.entity_text.begin(), bsp.entity_text.end());
    entity_text.push_back('\0');
    std::vector<TexinfoRecord> texinfos;
    texinfos.reserve(bsp.texinfos.size());
    for (const BspTexinfo& texinfo : bsp.texinfos)
        texinfos.push_back(to_record(texinfo));

    LumpWriter writer;
    writer.add(Entities, entity_text);
    writer.add(Planes, bsp.planes);
    writer.add(Vertices, bsp.vertices);
    writer.add(Visibility, bsp.visibility);
    writer.add(Nodes, bsp.nodes);
    writer.add(Texinfos, texinfos);
    writer.add(Faces, bsp.faces);
    writer.add(Lighting, bsp.lighting);
    writer.add(Leaves, bsp.leaves);
    writer.add(LeafFaces, bsp.leaf_faces);
    writer.add(LeafBrushes, bsp.leaf_brushes);
    writer.add(Edges, bsp.edges);
    writer.add(SurfaceEdges, bsp.surface_edges);
    writer.add(Models, bsp.models);
    writer.add(Brushes, bsp.brushes);
    writer.add(BrushSides, bsp.brush_sides);
    writer.add(Areas, bsp.areas);
    writer.add(AreaPortals, bsp.area_portals);
    return writer.finish();
}

} // namespace formats
