// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/compiler.hpp"

#include "common/parallel.hpp"
#include "tools/map_compiler/emit.hpp"
#include "tools/map_compiler/lighting.hpp"
#include "tools/map_compiler/visibility.hpp"

#include <fmt/format.h>
#include <thread>

namespace vkpt::tools {

namespace {

[[noreturn]] void fail_leak(const SourceMap& world, const Leak& leak)
{
    const MapEntity& entity = world.source.entities[size_t(leak.entity)];
    throw LeakError(world.source.file, entity.line,
        fmt::format(
            "the map leaks: entity {} ({}) at ({}) reaches the outside; follow the point file's line to the hole and "
            "close it with a structural (not detail) brush",
            leak.entity, entity.class_name(), entity.get("origin")),
        leak.points);
}

struct Compiled {
    Tree tree;
    FaceSet faces;
};

// Twice: the first tree tells which sides can be seen; the second is divided by those first.
Compiled compile_world(SourceMap& world, AreaRecords& areas, const CompileOptions& options)
{
    BrushModel& model = world.models[0];
    Compiled result;
    for (int pass = 0; pass < 2; pass++) {
        result.tree = build_tree(world, model);
        make_portals(result.tree, world.planes, PortalScope::leaves);
        const FloodResult flood = fill_outside(result.tree, world);
        if (!flood.leaks.empty())
            fail_leak(world, flood.leaks[0]);
        if (!flood.any_entity_inside && pass == 0)
            options.warn(
                fmt::format("{}: no entity stands inside the map, so the outside cannot be told from the inside; "
                            "add an info_player_start",
                    world.source.file));
        mark_visible_sides(result.tree, world, model);
    }
    areas = find_areas(result.tree, world, options.warn);
    result.faces = make_faces(result.tree, world);
    return result;
}

Compiled compile_brush_model(const SourceMap& world, BrushModel& model)
{
    Compiled result;
    result.tree = build_tree(world, model);
    make_portals(result.tree, world.planes, PortalScope::leaves);
    mark_visible_sides(result.tree, world, model);
    result.faces = make_faces(result.tree, world);
    return result;
}

std::vector<uint8_t> compile_visibility(const ClusterGraph& graph, const CompileOptions& options, unsigned threads)
{
    VisibilityOptions visibility;
    visibility.threads = threads;
    if (graph.portals.size() > visibility.max_flow_portals)
        options.warn(fmt::format(
            "{} portals: too many to follow every line of sight; the visible sets are larger than needed. Make "
            "small brushes detail",
            graph.portals.size()));
    return pack_visibility(compute_visibility(graph, visibility));
}

} // namespace

formats::Bsp compile_map(std::string_view text, std::string_view file, const CompileOptions& options)
{
    const unsigned threads = options.threads > 0 ? unsigned(options.threads) : core_count();
    TextureLibrary textures(options.textures);
    SourceMap world = build_world(parse_map(text, file), textures, options.warn);
    for (const std::string& name : textures.missing())
        options.warn(fmt::format(
            "{}: texture {} is not in {}; it is compiled without flags", file, name, options.textures.string()));
    BspWriter writer(world, options.format);
    AreaRecords areas;
    Compiled compiled = compile_world(world, areas, options);
    // The cluster portals replace the leaf portals, which the file's leaves need: work on a copy.
    Tree clusters = compiled.tree;
    const ClusterGraph graph = make_clusters(clusters, world.planes);
    for (size_t i = 0; i < clusters.nodes.size(); i++)
        compiled.tree.nodes[i].cluster = clusters.nodes[i].cluster;
    writer.add_model(compiled.tree, compiled.faces, world.models[0]);
    options.progress(fmt::format("{} brushes, {} clusters, {} portals", world.models[0].brushes.size(),
        graph.cluster_count, graph.portals.size()));
    for (size_t i = 1; i < world.models.size(); i++) {
        const Compiled model = compile_brush_model(world, world.models[i]);
        writer.add_model(model.tree, model.faces, world.models[i]);
    }
    std::vector<uint8_t> visibility;
    if (options.visibility)
        visibility = compile_visibility(graph, options, threads);
    formats::Bsp bsp = writer.finish(std::move(areas), std::move(visibility), graph.cluster_count);
    if (options.light)
        light_map(bsp, world, threads, options.progress);
    return bsp;
}

} // namespace vkpt::tools
