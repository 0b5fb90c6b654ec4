// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/brushes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/trigonometric.hpp>

namespace vkpt::tools {

using namespace formats;

namespace {

struct TextureAxes {
    dvec3 normal, s, t;
};

// Classic sides take the axis pair of the nearest of these six directions; in a tie the first one wins.
const TextureAxes classic_axes[6] = {
    { { 0, 0, 1 }, { 1, 0, 0 }, { 0, -1, 0 } },
    { { 0, 0, -1 }, { 1, 0, 0 }, { 0, -1, 0 } },
    { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } },
    { { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } },
    { { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, -1 } },
    { { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, -1 } },
};

std::array<dvec3, 2> rotated_classic_axes(const dvec3& normal, double degrees)
{
    const TextureAxes* best = classic_axes;
    double best_dot = 0;
    for (const TextureAxes& axes : classic_axes)
        if (const double dot = glm::dot(normal, axes.normal); dot > best_dot + 1e-6) {
            best_dot = dot;
            best = &axes;
        }
    // The editors turn about the projection axis, in the plane of the two world axes that s and t lie on.
    const double sine = std::sin(glm::radians(degrees)), cosine = std::cos(glm::radians(degrees));
    const auto main_axis = [](const dvec3& v) { return v.x != 0 ? 0 : v.y != 0 ? 1 : 2; };
    const int s_axis = main_axis(best->s), t_axis = main_axis(best->t);
    std::array<dvec3, 2> result { best->s, best->t };
    for (dvec3& axis : result) {
        const double s = axis[s_axis], t = axis[t_axis];
        axis[s_axis] = cosine * s - sine * t;
        axis[t_axis] = sine * s + cosine * t;
    }
    return result;
}

// Beyond these a side's texture coordinates are no longer exact to the texel in the file's 32-bit numbers, and its
// lightmap cannot be laid out. Editors write scales of 0.05 and shifts of some hundred.
constexpr double max_texels_per_unit = 1000, max_shift = 1 << 20;
// What the file can hold, see BspWriter::finish; told as soon as it is passed, as each more is compared with all
// before.
constexpr size_t max_texinfos = 8192, max_planes = 65536;

class WorldBuilder {
public:
    WorldBuilder(MapSource source, TextureLibrary& textures, const WarningSink& warn)
        : textures_(textures)
        , warn_(warn)
    {
        world_.source = std::move(source);
    }

    SourceMap build()
    {
        world_.models.push_back({});
        for (size_t i = 0; i < world_.source.entities.size(); i++)
            add_entity(int(i));
        if (world_.models[0].brushes.empty())
            world_.source.fail(world_.source.entities[0].line, "worldspawn has no brushes; the map needs walls");
        assign_switchable_styles();
        return std::move(world_);
    }

private:
    void add_entity(int index)
    {
        MapEntity& entity = world_.source.entities[size_t(index)];
        const std::string class_name(entity.class_name());
        const bool area_portal = class_name == "func_areaportal";
        if (index > 0 && entity.brushes.empty())
            return;
        if (area_portal)
            entity.set("style", fmt::format("{}", ++world_.area_portal_count));
        const bool joins_world = index == 0 || class_name == "func_group" || area_portal;
        BrushModel model;
        model.entity = index;
        if (!joins_world)
            model.origin = find_origin(entity);
        for (const MapBrushSource& source : entity.brushes) {
            Brush brush = build_brush(source, model.origin);
            if (brush.contents & contents_origin) {
                if (joins_world)
                    warn_at(source.line, "an origin brush has no meaning outside a brush entity; it is left out");
                continue;
            }
            if (area_portal) {
                brush.contents = CONTENTS_AREAPORTAL;
                brush.area_portal = world_.area_portal_count;
            }
            (joins_world ? world_.models[0] : model).brushes.push_back(std::move(brush));
        }
        if (joins_world)
            return;
        if (model.brushes.empty())
            world_.source.fail(entity.line, fmt::format("{} has no brush beside its origin brush", class_name));
        entity.set("model", fmt::format("*{}", world_.models.size()));
        if (model.origin != dvec3(0))
            entity.set("origin", fmt::format("{:g} {:g} {:g}", model.origin.x, model.origin.y, model.origin.z));
        world_.models.push_back(std::move(model));
    }

    dvec3 find_origin(const MapEntity& entity)
    {
        for (const MapBrushSource& source : entity.brushes) {
            const bool is_origin = std::ranges::all_of(source.sides, [&](const MapSide& side) {
                const TextureInfo& texture = textures_.find(side.texture);
                return (texture.contents | texture.tool_contents) & contents_origin;
            });
            if (!is_origin)
                continue;
            const Brush brush = build_brush(source, dvec3(0));
            return (brush.bounds.mins + brush.bounds.maxs) * 0.5;
        }
        return dvec3(0);
    }

    Brush build_brush(const MapBrushSource& source, const dvec3& origin)
    {
        Brush brush;
        brush.line = source.line;
        for (const MapSide& side : source.sides)
            add_side(brush, side, origin);
        make_windings(brush);
        decide_contents(brush);
        add_bevels(brush);
        return brush;
    }

    void add_side(Brush& brush, const MapSide& source, const dvec3& origin)
    {
        const auto& [a, b, c] = source.points;
        const dvec3 cross = glm::cross(a - b, c - b);
        const double length = glm::length(cross);
        if (!(length > 1e-9))
            world_.source.fail(
                source.line, "the side's three points lie on one line and give no plane; rebuild this brush");
        const dvec3 normal = cross / length;
        BrushSide side;
        side.line = source.line;
        side.plane = world_.planes.find(normal, glm::dot(normal, a - origin));
        if (world_.planes.size() > max_planes)
            world_.source.fail(source.line, fmt::format("more than {} planes; remove brushes or sides", max_planes));
        for (const BrushSide& other : brush.sides) {
            if (other.plane == side.plane) {
                warn_at(source.line, "this side repeats a plane of its brush; it is left out");
                return;
            }
            if (other.plane == (side.plane ^ 1))
                world_.source.fail(
                    source.line, "two sides of the brush face each other on one plane: it has no volume; delete it");
        }
        const TextureInfo& texture = textures_.find(source.texture);
        const MapSide::Surface surface
            = source.surface.value_or(MapSide::Surface { texture.contents, texture.flags, texture.value });
        side.flags = surface.flags | texture.tool_flags;
        side.contents = side_contents(surface.contents | texture.tool_contents, side.flags);
        side.divides = !(side.flags & SURF_SKIP);
        side.texinfo = make_texinfo(source, world_.planes[side.plane].normal, side.flags, surface.value, origin);
        brush.sides.push_back(side);
    }

    // Glass and clip brushes do not cut the world into clusters; a brush that says nothing is a wall.
    static uint32_t side_contents(uint32_t contents, uint32_t flags)
    {
        if (flags & (SURF_TRANS33 | SURF_TRANS66))
            contents |= CONTENTS_DETAIL;
        if (contents & clip_contents)
            contents |= CONTENTS_DETAIL;
        if (!(contents & (visible_contents_mask | clip_contents | contents_origin | CONTENTS_AREAPORTAL)))
            contents |= CONTENTS_SOLID;
        if (flags & (SURF_HINT | SURF_SKIP))
            contents = 0;
        return contents;
    }

    void make_windings(Brush& brush)
    {
        int kept = 0;
        for (BrushSide& side : brush.sides) {
            side.winding = make_base_winding(world_.planes[side.plane]);
            for (const BrushSide& other : brush.sides)
                if (&other != &side && !side.winding.empty())
                    side.winding = clip_winding(side.winding, world_.planes[other.plane ^ 1], 1e-4);
            if (is_tiny(side.winding))
                side.winding.clear();
            kept += !side.winding.empty();
            brush.bounds.add(side.winding);
        }
        if (kept < 4)
            world_.source.fail(brush.line, "the brush's planes enclose no volume; delete or rebuild it");
        for (int axis = 0; axis < 3; axis++)
            if (brush.bounds.mins[axis] < -world_limit || brush.bounds.maxs[axis] > world_limit)
                world_.source.fail(brush.line,
                    fmt::format(
                        "the brush is open or reaches beyond +-{:.0f} units; close it or move it in", world_limit));
        std::erase_if(brush.sides, [](const BrushSide& side) { return side.winding.empty(); });
    }

    void decide_contents(Brush& brush)
    {
        brush.contents = brush.sides[0].contents;
        uint32_t flags = 0;
        for (const BrushSide& side : brush.sides) {
            flags |= side.flags;
            brush.contents |= side.contents & CONTENTS_DETAIL;
            if ((side.contents ^ brush.sides[0].contents) & ~CONTENTS_DETAIL)
                mixed_line_ = brush.line;
        }
        if (flags & (SURF_HINT | SURF_SKIP))
            brush.contents = 0;
        else if (mixed_line_ == brush.line)
            warn_at(brush.line, "the brush's sides disagree on their contents; the first side decides");
        if (flags & (SURF_TRANS33 | SURF_TRANS66) && brush.contents != 0)
            brush.contents |= CONTENTS_TRANSLUCENT;
        if (brush.contents & contents_origin)
            brush.contents = contents_origin;
        for (BrushSide& side : brush.sides)
            side.divides = side.divides && (brush.contents != 0 || side.flags & SURF_HINT);
    }

    // A box is traced as a point against the brush grown by the box. Where edges are not square, the grown brush needs
    // planes that the brush itself has not: the six axial ones, and one through each edge along each world axis.
    void add_bevels(Brush& brush)
    {
        for (int axis = 0; axis < 3; axis++)
            for (const double sign : { -1.0, 1.0 }) {
                dvec3 normal(0);
                normal[axis] = sign;
                add_bevel(brush, normal, sign > 0 ? brush.bounds.maxs[axis] : -brush.bounds.mins[axis]);
            }
        const size_t solid_sides = brush.sides.size();
        for (size_t i = 0; i < solid_sides; i++)
            for (size_t k = 0; k < brush.sides[i].winding.size(); k++)
                add_edge_bevels(
                    brush, brush.sides[i].winding[k], brush.sides[i].winding[(k + 1) % brush.sides[i].winding.size()]);
    }

    void add_edge_bevels(Brush& brush, const dvec3 a, const dvec3 b)
    {
        const double length = glm::distance(a, b);
        if (length < 0.5)
            return;
        const dvec3 edge = (b - a) / length;
        for (int axis = 0; axis < 3; axis++)
            if (std::abs(edge[axis]) > 1.0 - 1e-6)
                return; // an axial edge is covered by the axial planes
        for (int axis = 0; axis < 3; axis++)
            for (const double sign : { -1.0, 1.0 }) {
                dvec3 direction(0);
                direction[axis] = sign;
                const dvec3 cross = glm::cross(edge, direction);
                const double size = glm::length(cross);
                if (size < 0.5)
                    continue;
                const dvec3 normal = cross / size;
                const double dist = glm::dot(normal, a);
                if (is_supporting(brush, normal, dist))
                    add_bevel(brush, normal, dist);
            }
    }

    // The whole brush lies behind the plane.
    static bool is_supporting(const Brush& brush, const dvec3& normal, double dist)
    {
        for (const BrushSide& side : brush.sides)
            for (const dvec3& p : side.winding)
                if (glm::dot(normal, p) - dist > 0.1)
                    return false;
        return true;
    }

    void add_bevel(Brush& brush, const dvec3& normal, double dist)
    {
        BrushSide bevel;
        bevel.plane = world_.planes.find(normal, dist);
        for (const BrushSide& side : brush.sides)
            if (side.plane == bevel.plane)
                return;
        bevel.texinfo = brush.sides[0].texinfo;
        bevel.contents = brush.sides[0].contents;
        bevel.bevel = true;
        bevel.divides = false;
        brush.sides.push_back(bevel);
    }

    int make_texinfo(const MapSide& side, const dvec3& normal, uint32_t flags, int value, const dvec3& origin)
    {
        std::array<dvec3, 2> axes = side.valve_axes ? side.axes : rotated_classic_axes(normal, side.rotation);
        BspTexinfo info;
        std::array<double, 2> offset;
        for (size_t i = 0; i < 2; i++) {
            axes[i] /= side.scale[i] != 0 ? side.scale[i] : 1.0;
            offset[i] = side.shift[i] + glm::dot(origin, axes[i]);
            if (!(glm::length(axes[i]) <= max_texels_per_unit))
                world_.source.fail(side.line,
                    fmt::format(
                        "the texture is scaled to more than {:.0f} texels per unit; give the side a larger scale",
                        max_texels_per_unit));
            if (!(std::abs(side.shift[i]) <= max_shift))
                world_.source.fail(
                    side.line, fmt::format("the texture is shifted by more than {:.0f} texels", max_shift));
        }
        info.s_axis = axes[0];
        info.t_axis = axes[1];
        info.s_offset = float(offset[0]);
        info.t_offset = float(offset[1]);
        info.flags = flags;
        info.value = value;
        info.next = -1;
        info.texture = side.texture;
        if (info.texture.size() > 31)
            world_.source.fail(
                side.line, fmt::format("texture name \"{}\" is longer than 31 letters; shorten it", info.texture));
        return find_texinfo(info);
    }

    int find_texinfo(const BspTexinfo& info)
    {
        const auto same = [&](const BspTexinfo& other) {
            return other.texture == info.texture && other.flags == info.flags && other.value == info.value
                && other.s_axis == info.s_axis && other.t_axis == info.t_axis && other.s_offset == info.s_offset
                && other.t_offset == info.t_offset;
        };
        const auto found = std::ranges::find_if(world_.texinfos, same);
        if (found != world_.texinfos.end())
            return int(found - world_.texinfos.begin());
        const int index = int(world_.texinfos.size());
        if (world_.texinfos.size() >= max_texinfos)
            world_.source.fail(0,
                fmt::format(
                    "more than {} texture placements; let sides share shift, rotation and scale", max_texinfos));
        const TextureInfo& texture = textures_.find(info.texture);
        world_.texinfos.push_back(info);
        world_.light_colour.push_back(texture.light_colour);
        world_.reflectivity.push_back(texture.reflectivity);
        if (!texture.next_animation.empty()) {
            BspTexinfo next = info;
            next.texture = texture.next_animation;
            const int next_index = find_texinfo(next); // ends: a chain that returns finds its first texinfo
            world_.texinfos[size_t(index)].next = next_index;
        }
        return index;
    }

    // Lights with a name can be switched; lights of one name share a style. The engine keeps 0..31 for its patterns.
    void assign_switchable_styles()
    {
        std::vector<std::string> names;
        for (MapEntity& entity : world_.source.entities) {
            const std::string name(entity.get("targetname"));
            if (name.empty() || !entity.class_name().starts_with("light"))
                continue;
            auto it = std::ranges::find(names, name);
            if (it == names.end())
                it = names.insert(it, name);
            const auto style = 32 + (it - names.begin());
            if (style > 62)
                world_.source.fail(entity.line, "more than 31 switchable lights; give some the same targetname");
            entity.set("style", fmt::format("{}", style));
        }
    }

    void warn_at(int line, std::string_view reason) { warn_(MapError(world_.source.file, line, reason).what()); }

    SourceMap world_;
    TextureLibrary& textures_;
    const WarningSink& warn_;
    int mixed_line_ = -1;
};

} // namespace

std::string SourceMap::entity_text() const
{
    std::string text;
    for (const MapEntity& entity : source.entities) {
        const std::string_view class_name = entity.class_name();
        if (class_name == "func_group" && !entity.brushes.empty())
            continue;
        text += "{\n";
        for (const auto& [key, value] : entity.pairs)
            text += fmt::format("\"{}\" \"{}\"\n", key, value);
        text += "}\n";
    }
    return text;
}

SourceMap build_world(MapSource source, TextureLibrary& textures, const WarningSink& warn)
{
    return WorldBuilder(std::move(source), textures, warn).build();
}

} // namespace vkpt::tools
