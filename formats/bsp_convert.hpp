// SPDX-License-Identifier: GPL-2.0-or-later
// Records of a BSP between memory and disk.
#pragma once

#include "formats/bsp_disk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace formats::bsp_disk {

// A number that the field of the file has no room for.
class DoesNotFit : public std::invalid_argument {
public:
    explicit DoesNotFit(double number)
        : std::invalid_argument(std::abs(number) < 1e10 && number == std::trunc(number)
                ? std::to_string(int64_t(number))
                : std::to_string(number))
    {
    }
};

template <class To, class From> To convert_number(From from)
{
    if constexpr (std::is_integral_v<To>) {
        using Limits = std::numeric_limits<To>;
        if (!(double(from) >= double(Limits::min()) && double(from) <= double(Limits::max()))
            || double(To(from)) != double(from))
            throw DoesNotFit(double(from));
    }
    return To(from);
}

// The fields of records that differ in nothing but their width.
template <class T, class... Records>
concept OneOf = (std::is_same_v<std::remove_const_t<T>, Records> || ...);

auto fields(OneOf<BspNode, NarrowNode> auto& n)
{
    return std::tie(n.plane, n.children[0], n.children[1], n.mins[0], n.mins[1], n.mins[2], n.maxs[0], n.maxs[1],
        n.maxs[2], n.first_face, n.face_count);
}
auto fields(OneOf<BspLeaf, NarrowLeaf> auto& l)
{
    return std::tie(l.contents, l.cluster, l.area, l.mins[0], l.mins[1], l.mins[2], l.maxs[0], l.maxs[1], l.maxs[2],
        l.first_leaf_face, l.leaf_face_count, l.first_leaf_brush, l.leaf_brush_count);
}
auto fields(OneOf<BspFace, NarrowFace> auto& f)
{
    return std::tie(f.plane, f.side, f.first_edge, f.edge_count, f.texinfo, f.styles[0], f.styles[1], f.styles[2],
        f.styles[3], f.light_offset);
}
auto fields(OneOf<BspEdge, NarrowEdge> auto& e) { return std::tie(e.vertices[0], e.vertices[1]); }
auto fields(OneOf<BspBrushSide, NarrowBrushSide> auto& s) { return std::tie(s.plane, s.texinfo); }
auto fields(OneOf<uint32_t, uint16_t> auto& index) { return std::tie(index); }

// Throws DoesNotFit.
template <class To, class From> void convert_record(const From& from, To& to)
{
    const auto convert_all = [&]<size_t... i>(std::index_sequence<i...>, const auto& source, const auto& target)
    {
        ((std::get<i>(target)
             = convert_number<std::remove_reference_t<decltype(std::get<i>(target))>>(std::get<i>(source))),
            ...);
    };
    const auto source = fields(from);
    convert_all(std::make_index_sequence<std::tuple_size_v<decltype(source)>>(), source, fields(to));
}

inline void convert_record(const TexinfoRecord& r, BspTexinfo& texinfo)
{
    const std::string name(r.texture.begin(), std::find(r.texture.begin(), r.texture.end(), '\0'));
    texinfo = { r.s_axis, r.s_offset, r.t_axis, r.t_offset, r.flags, r.value, name, r.next };
}

inline void convert_record(const BspTexinfo& texinfo, TexinfoRecord& r)
{
    if (texinfo.texture.size() >= texture_name_size)
        throw std::invalid_argument("texture name \"" + texinfo.texture + "\" is longer than 31 bytes");
    r = { texinfo.s_axis, texinfo.s_offset, texinfo.t_axis, texinfo.t_offset, texinfo.flags, texinfo.value, {},
        texinfo.next };
    std::copy(texinfo.texture.begin(), texinfo.texture.end(), r.texture.begin());
}

} // namespace formats::bsp_disk
