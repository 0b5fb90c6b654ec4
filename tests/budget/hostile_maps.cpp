// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/budget/hostile_maps.hpp"

#include "formats/bsp.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

namespace vkpt::test {

namespace {

using formats::Bsp;

constexpr size_t max_bytes = 990'000;
constexpr uint32_t wall = 0, lamp = 1;

formats::BspTexinfo make_texinfo(const std::string& texture, uint32_t flags, int value)
{
    formats::BspTexinfo texinfo {};
    texinfo.s_axis = glm::vec3(1, 0, 0);
    texinfo.t_axis = glm::vec3(0, 1, 0);
    texinfo.flags = flags;
    texinfo.value = value;
    texinfo.texture = texture;
    texinfo.next = -1;
    return texinfo;
}

// One open leaf, the horizontal plane that all faces lie in as far as the reader knows, and two texinfos.
Bsp make_base()
{
    Bsp bsp;
    bsp.planes.push_back({ glm::vec3(0, 0, 1), 0, 2 });
    bsp.texinfos = { make_texinfo("wall", 0, 0), make_texinfo("lamp", formats::SURF_LIGHT, 1000) };
    formats::BspLeaf leaf {};
    leaf.cluster = -1;
    bsp.leaves.push_back(leaf);
    formats::BspModel world {};
    world.head_node = -1;
    bsp.models.push_back(world);
    bsp.vertices.emplace_back(0);
    bsp.edges.push_back({});
    return bsp;
}

// The world is all faces.
void finish_world(Bsp& bsp) { bsp.models[0].face_count = int32_t(bsp.faces.size()); }

void add_edges(Bsp& bsp, size_t first_vertex, size_t count)
{
    for (size_t i = 0; i < count; i++)
        bsp.edges.push_back({ { uint32_t(first_vertex + i), uint32_t(first_vertex + (i + 1) % count) } });
}

// Corners on a circle, clockwise as on disk; returns the first of its edges, which faces share.
size_t add_polygon(Bsp& bsp, size_t corners, float radius, glm::vec3 centre = glm::vec3(0))
{
    const size_t first_edge = bsp.edges.size(), first_vertex = bsp.vertices.size();
    for (size_t i = 0; i < corners; i++) {
        const float angle = -2 * std::numbers::pi_v<float> * (float(i) + 0.5f) / float(corners);
        bsp.vertices.push_back(centre + radius * glm::vec3(std::cos(angle), std::sin(angle), 0));
    }
    add_edges(bsp, first_vertex, corners);
    return first_edge;
}

void add_face(Bsp& bsp, size_t first_edge, size_t corners, uint32_t texinfo)
{
    formats::BspFace face {};
    face.first_edge = int32_t(bsp.surface_edges.size());
    face.edge_count = uint32_t(corners);
    face.texinfo = texinfo;
    face.light_offset = -1;
    for (size_t i = 0; i < corners; i++)
        bsp.surface_edges.push_back(int32_t(first_edge + i));
    bsp.faces.push_back(face);
}

// As many alike as fit.
void add_faces(Bsp& bsp, size_t corners, float radius, uint32_t texinfo, size_t bytes = max_bytes)
{
    const size_t edge = add_polygon(bsp, corners, radius);
    for (size_t used = 5000; used + 20 + 4 * corners < bytes && bsp.faces.size() < 60000; used += 20 + 4 * corners)
        add_face(bsp, edge, corners, texinfo);
}

// `count` clusters that all see each other, through one row that all share.
void add_clusters(Bsp& bsp, size_t count)
{
    bsp.cluster_count = int(count);
    const uint32_t header[] = { uint32_t(count) };
    const uint32_t row = uint32_t(4 + 8 * count);
    bsp.visibility.assign(row + (count + 7) / 8, 0xff);
    std::memcpy(bsp.visibility.data(), header, 4);
    for (size_t i = 0; i < 2 * count; i++)
        std::memcpy(bsp.visibility.data() + 4 + 4 * i, &row, 4);
}

// A tree all of whose planes pass through the origin, so that what lies there is on both sides of each; every leaf is
// in a cluster of its own, if there are so many, and all of space.
void add_tree(Bsp& bsp, size_t nodes, size_t clusters)
{
    bsp.leaves.clear();
    for (size_t i = 0; i <= nodes; i++) {
        formats::BspLeaf leaf {};
        leaf.cluster = clusters > 0 ? int32_t(i % clusters) : -1;
        for (int axis = 0; axis < 3; axis++) {
            leaf.mins[axis] = -4096;
            leaf.maxs[axis] = 4096;
        }
        bsp.leaves.push_back(leaf);
    }
    const std::function<int32_t(size_t, size_t)> build = [&](size_t first, size_t count) -> int32_t {
        if (count == 1)
            return -int32_t(first) - 1;
        const size_t node = bsp.nodes.size();
        bsp.nodes.emplace_back();
        const int32_t front = build(first, count / 2), back = build(first + count / 2, count - count / 2);
        bsp.nodes[node].plane = int32_t(node % bsp.planes.size());
        bsp.nodes[node].children[0] = front;
        bsp.nodes[node].children[1] = back;
        return int32_t(node);
    };
    bsp.models[0].head_node = build(0, nodes + 1);
}

void add_lights(Bsp& bsp, size_t bytes)
{
    bsp.entity_text = "{classname worldspawn}";
    while (bsp.entity_text.size() < bytes)
        bsp.entity_text += "{classname light origin\"0 0 0\"}";
}

// Triangles that lie in one another, each as much smaller as `ratio` says, around a centre that moves with `shift`.
Bsp make_nested(float ratio, float shift)
{
    Bsp bsp = make_base();
    float size = 4000;
    while (bsp.faces.size() < 12000) {
        const glm::vec3 centre(shift * size, shift * size, shift * size);
        const size_t edge = add_polygon(bsp, 3, size, centre);
        add_face(bsp, edge, 3, wall);
        size *= ratio;
        if (size < 1e-3f)
            size = 4000;
    }
    finish_world(bsp);
    return bsp;
}

Bsp make_stretched(glm::vec3 s_axis, float s_offset)
{
    Bsp bsp = make_base();
    bsp.texinfos[lamp].s_axis = s_axis;
    bsp.texinfos[lamp].s_offset = s_offset;
    add_face(bsp, add_polygon(bsp, 4, 300), 4, lamp);
    finish_world(bsp);
    return bsp;
}

Bsp make_polygons(size_t corners, float radius, uint32_t texinfo, size_t bytes = max_bytes)
{
    Bsp bsp = make_base();
    add_faces(bsp, corners, radius, texinfo, bytes);
    finish_world(bsp);
    return bsp;
}

Bsp make_lights_in_clusters(size_t light_bytes, size_t clusters, size_t nodes)
{
    Bsp bsp = make_base();
    add_clusters(bsp, clusters);
    if (nodes > 0)
        add_tree(bsp, nodes, clusters);
    else
        bsp.leaves[0].cluster = 0;
    add_lights(bsp, light_bytes);
    return bsp;
}

// Without visibility a leaf's number is what makes clusters.
Bsp make_unseen_clusters()
{
    Bsp bsp = make_base();
    bsp.leaves[0].cluster = 32767;
    add_lights(bsp, 1800);
    return bsp;
}

Bsp make_lamps_in_clusters(size_t face_bytes, size_t clusters, size_t nodes)
{
    Bsp bsp = make_base();
    add_clusters(bsp, clusters);
    add_tree(bsp, nodes, clusters);
    bsp.texinfos[lamp].next = lamp; // whole faces
    add_faces(bsp, 4, 100, lamp, face_bytes);
    finish_world(bsp);
    return bsp;
}

// A light in a wall looks at 135 places to come out of it.
Bsp make_buried_lights()
{
    Bsp bsp = make_base();
    add_tree(bsp, 8000, 0);
    bsp.leaves[0].contents = formats::CONTENTS_SOLID; // the last one that a walk comes to
    add_lights(bsp, 400'000);
    return bsp;
}

// A tree that is nothing but one long branch, and faces at its end.
Bsp make_long_branch()
{
    Bsp bsp = make_base();
    for (int i = 0; i < 4096; i++) {
        formats::BspNode node {};
        node.children[0] = i < 4095 ? i + 1 : -1;
        node.children[1] = -1;
        bsp.nodes.push_back(node);
    }
    bsp.models[0].head_node = 0;
    add_clusters(bsp, 1);
    bsp.leaves[0].cluster = 0;
    add_faces(bsp, 4, 100, lamp, 700'000);
    finish_world(bsp);
    return bsp;
}

// Every leaf shows the same face of many corners.
Bsp make_shared_leaf_faces(size_t entries)
{
    Bsp bsp = make_base();
    add_clusters(bsp, 8);
    add_face(bsp, add_polygon(bsp, 64, 300), 64, lamp);
    finish_world(bsp);
    bsp.leaf_faces.assign(entries, 0);
    bsp.leaves.clear();
    for (size_t first = 0; first < entries; first += 8192) {
        formats::BspLeaf leaf {};
        leaf.cluster = 0;
        leaf.first_leaf_face = uint32_t(first);
        leaf.leaf_face_count = uint32_t(std::min<size_t>(8192, entries - first));
        for (int axis = 0; axis < 3; axis++) {
            leaf.mins[axis] = -4096;
            leaf.maxs[axis] = 4096;
        }
        bsp.leaves.push_back(leaf);
    }
    return bsp;
}

// Texinfos in rings of `length`, and faces that use them.
Bsp make_rings(size_t count, size_t length)
{
    Bsp bsp = make_base();
    bsp.texinfos.clear();
    for (size_t i = 0; i < count; i++) {
        bsp.texinfos.push_back(make_texinfo("a", 0, 0));
        const size_t start = i / length * length, end = std::min(start + length, count);
        bsp.texinfos.back().next = int32_t(i + 1 < end ? i + 1 : start);
    }
    add_faces(bsp, 4, 100, 0, max_bytes - 76 * count);
    finish_world(bsp);
    return bsp;
}

Bsp make_many_models()
{
    Bsp bsp = make_base();
    const size_t edge = add_polygon(bsp, 4, 30);
    while (bsp.models.size() < 10000) {
        formats::BspModel model = bsp.models[0];
        model.first_face = int32_t(bsp.faces.size());
        model.face_count = 1;
        add_face(bsp, edge, 4, lamp);
        bsp.models.push_back(model);
    }
    return bsp;
}

// All models have all faces.
Bsp make_shared_model_faces()
{
    Bsp bsp = make_polygons(4, 100, wall);
    bsp.faces.resize(10000);
    bsp.surface_edges.resize(40000);
    finish_world(bsp);
    while (bsp.models.size() < 5000)
        bsp.models.push_back(bsp.models[0]);
    return bsp;
}

// One megabyte of zeros that is every lump at once would be; here two lumps that are the same bytes.
std::vector<std::byte> make_overlapping_lumps()
{
    Bsp bsp = make_polygons(4, 100, wall);
    std::vector<std::byte> file = formats::write_bsp(bsp);
    std::memcpy(file.data() + 8 + 8 * 7, file.data() + 8 + 8 * 6, 8); // light samples: the faces
    return file;
}

// Every face has all of the map's luxels.
Bsp make_shared_lightmap()
{
    constexpr size_t light_bytes = 300'000;
    Bsp bsp = make_base();
    add_faces(bsp, 4, 3500, wall, max_bytes - light_bytes);
    for (formats::BspFace& face : bsp.faces) {
        face.light_offset = 0;
        face.styles[1] = 255; // one
    }
    bsp.lighting.assign(light_bytes, 128);
    finish_world(bsp);
    return bsp;
}

} // namespace

std::vector<HostileMap> make_hostile_maps()
{
    constexpr bool refused = true, loads = false;
    std::vector<HostileMap> maps;
    const auto add = [&](const char* name, const Bsp& bsp, bool is_refused) {
        maps.push_back({ name, formats::write_bsp(bsp), is_refused });
    };
    // A picture's tiles counted in floats: the counter stands still, or one count is huge and the other 0.
    add("tiles far away", make_stretched({ 1, 0, 0 }, 2147483648.0f), loads);
    add("tiles without number", make_stretched({ 1e30f, 0, 0 }, 0), loads);
    add("tiles in one row", make_stretched({ 1e7f, 0, 0 }, 16777216.0f), loads);
    // Faces: corners, and pieces around the lamps in their picture.
    add("65 corners", make_polygons(65, 300, wall), refused);
    add("64 corners", make_polygons(64, 300, lamp), loads);
    add("64 corners, a few lamps", make_polygons(64, 30, lamp), refused);
    add("64 corners, no lamps", make_polygons(64, 300, wall), loads);
    add("40 corners, no lamps", make_polygons(40, 30, wall), loads);
    add("one tile", make_polygons(4, 40, lamp, 250'000), loads);
    add("four tiles", make_polygons(4, 80, lamp), refused);
    add("64 tiles", make_polygons(4, 350, lamp), refused);
    add("one lightmap for all faces", make_shared_lightmap(), loads);
    // Clusters times lights.
    add("lights, clusters without leaves", make_lights_in_clusters(640'000, 32768, 0), refused);
    add("few lights, clusters without leaves", make_lights_in_clusters(1800, 32768, 0), loads);
    add("lights, clusters", make_lights_in_clusters(300'000, 7000, 7000), refused);
    add("lights, few clusters", make_lights_in_clusters(700'000, 64, 64), loads);
    add("many lamps, clusters", make_lamps_in_clusters(500'000, 5000, 7000), refused);
    add("few lamps, clusters", make_lamps_in_clusters(10'000, 7000, 7000), loads);
    add("lamps, few clusters", make_lamps_in_clusters(950'000, 36, 36), loads);
    add("buried lights", make_buried_lights(), refused);
    add("one long branch", make_long_branch(), refused);
    // Triangles that no tree can part.
    add("nested triangles", make_nested(0.999f, 0), loads);
    add("nested triangles aside", make_nested(0.999f, 1), loads);
    add("halved triangles", make_nested(0.5f, 1), loads);
    add("equal triangles", make_polygons(3, 100, wall), loads);
    // Records that are used again and again.
    add("leaf faces", make_shared_leaf_faces(65536), refused);
    add("fewer leaf faces", make_shared_leaf_faces(16384), loads);
    add("a ring of texinfos", make_rings(12000, 12000), refused);
    add("rings of texinfos", make_rings(6000, 256), loads);
    add("models", make_many_models(), loads);
    add("models of the same faces", make_shared_model_faces(), refused);
    // As QBSP.
    const auto add_wide = [&](const char* name, Bsp bsp, bool is_refused) {
        bsp.format = formats::BspFormat::qbsp;
        add(name, bsp, is_refused);
    };
    add_wide("QBSP: too many clusters", make_lights_in_clusters(1800, 65536, 0), refused);
    add_wide("QBSP: few lights, clusters without leaves", make_lights_in_clusters(1800, 32768, 0), loads);
    add_wide("QBSP: no visibility, clusters without leaves", make_unseen_clusters(), loads);
    add_wide("QBSP: lights, clusters", make_lights_in_clusters(300'000, 6000, 6000), refused);
    add_wide("QBSP: few lamps, clusters", make_lamps_in_clusters(10'000, 6000, 6000), loads);
    add_wide("QBSP: leaf faces", make_shared_leaf_faces(65536 + 8192), refused);
    maps.push_back({ "overlapping lumps", make_overlapping_lumps(), refused });
    return maps;
}

} // namespace vkpt::test
