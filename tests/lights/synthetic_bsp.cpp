// SPDX-License-Identifier: GPL-2.0-or-later
#include "synthetic_bsp.hpp"

#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

namespace vkpt::test {

namespace {

using formats::Bsp;

class CellMapBuilder {
public:
    CellMapBuilder(int size, const std::vector<bool>& open)
        : size_(size)
        , open_(open)
    {
    }

    Bsp build()
    {
        bsp_.name = "cells";
        formats::BspLeaf solid {};
        solid.contents = formats::CONTENTS_SOLID;
        solid.cluster = -1;
        bsp_.leaves.push_back(solid);
        bsp_.edges.push_back({});
        add_texinfos();
        leaf_of_cell_.assign(size_t(size_ * size_), 0);

        // The walls around, then the cells: node i's front is node i + 1.
        const float end = float(size_) * cell_size;
        add_wall({ 0, 0, 1 }, 0);
        add_wall({ 0, 0, -1 }, -cell_size);
        add_wall({ 1, 0, 0 }, 0);
        add_wall({ -1, 0, 0 }, -end);
        add_wall({ 0, 1, 0 }, 0);
        add_wall({ 0, -1, 0 }, -end);
        const int32_t cells = build_cells(0, 0, size_, size_);
        bsp_.nodes[5].children[0] = cells;

        formats::BspModel world {};
        world.maxs = glm::vec3(end, end, cell_size);
        world.face_count = int32_t(bsp_.faces.size());
        bsp_.models.push_back(world);
        add_visibility();
        return std::move(bsp_);
    }

private:
    void add_texinfos()
    {
        for (int i = 0; i < 4; i++) {
            formats::BspTexinfo texinfo {};
            texinfo.s_axis = glm::vec3(1, 0, 0);
            texinfo.t_axis = glm::vec3(0, -1, 0);
            texinfo.flags = i == 0 ? 0 : i == 3 ? uint32_t(formats::SURF_SKY) : uint32_t(formats::SURF_LIGHT);
            texinfo.value = i == 1 ? 100 : i == 2 ? 200 : 0;
            texinfo.texture = std::string("test/") + char('a' + i);
            texinfo.next = -1;
            bsp_.texinfos.push_back(texinfo);
        }
    }

    int32_t add_plane(glm::vec3 normal, float dist)
    {
        bsp_.planes.push_back({ normal, dist, 0 });
        return int32_t(bsp_.planes.size()) - 1;
    }

    void add_wall(glm::vec3 normal, float dist)
    {
        formats::BspNode node {};
        node.plane = add_plane(normal, dist);
        node.children[0] = int32_t(bsp_.nodes.size()) + 1;
        node.children[1] = -1;
        bsp_.nodes.push_back(node);
    }

    int32_t build_cells(int x0, int y0, int x1, int y1)
    {
        if (x1 - x0 == 1 && y1 - y0 == 1)
            return add_cell(x0, y0);
        const bool along_x = x1 - x0 >= y1 - y0;
        const int middle = along_x ? (x0 + x1) / 2 : (y0 + y1) / 2;
        const size_t node = bsp_.nodes.size();
        bsp_.nodes.emplace_back();
        bsp_.nodes[node].plane
            = add_plane(along_x ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0), float(middle) * cell_size);
        const int32_t front = along_x ? build_cells(middle, y0, x1, y1) : build_cells(x0, middle, x1, y1);
        const int32_t back = along_x ? build_cells(x0, y0, middle, y1) : build_cells(x0, y0, x1, middle);
        bsp_.nodes[node].children[0] = front;
        bsp_.nodes[node].children[1] = back;
        return int32_t(node);
    }

    int32_t add_cell(int x, int y)
    {
        const size_t cell = size_t(y * size_ + x);
        if (!open_[cell])
            return -1;
        formats::BspLeaf leaf {};
        leaf.cluster = bsp_.cluster_count++;
        const int mins[3] = { x, y, 0 };
        for (int axis = 0; axis < 3; axis++) {
            leaf.mins[axis] = float(mins[axis] * int(cell_size));
            leaf.maxs[axis] = float((mins[axis] + 1) * int(cell_size));
        }
        leaf_of_cell_[cell] = bsp_.leaves.size();
        bsp_.leaves.push_back(leaf);
        const glm::vec3 corner(float(x) * cell_size, float(y) * cell_size, 0);
        const glm::vec3 across_x(cell_size, 0, 0), across_y(0, cell_size, 0);
        add_face(bsp_, { corner, corner + across_x, corner + across_x + across_y, corner + across_y },
            glm::vec3(0, 0, 1), uint32_t(leaf.cluster % 4));
        return -int32_t(bsp_.leaves.size());
    }

    // Joins cells that touch by an edge or a corner: light passes diagonally through a shared corner only in the limit,
    // and the PVS may list too much but never too little.
    std::vector<int> label_components() const
    {
        std::vector<int> label(open_.size(), -1);
        for (size_t start = 0; start < open_.size(); start++) {
            if (!open_[start] || label[start] >= 0)
                continue;
            std::vector<size_t> pending { start };
            label[start] = int(start);
            while (!pending.empty()) {
                const int x = int(pending.back()) % size_, y = int(pending.back()) / size_;
                pending.pop_back();
                for (int dy = -1; dy <= 1; dy++)
                    for (int dx = -1; dx <= 1; dx++) {
                        const int nx = x + dx, ny = y + dy;
                        if (nx < 0 || ny < 0 || nx >= size_ || ny >= size_)
                            continue;
                        const size_t next = size_t(ny * size_ + nx);
                        if (open_[next] && label[next] < 0) {
                            label[next] = int(start);
                            pending.push_back(next);
                        }
                    }
            }
        }
        return label;
    }

    void add_visibility()
    {
        const std::vector<int> label = label_components();
        std::vector<int> component(size_t(bsp_.cluster_count), -1);
        for (size_t cell = 0; cell < open_.size(); cell++)
            if (open_[cell])
                component[size_t(bsp_.leaves[leaf_of_cell_[cell]].cluster)] = label[cell];

        const size_t header = 4 + 8 * component.size();
        bsp_.visibility.assign(header, 0);
        const uint32_t count = uint32_t(component.size());
        std::memcpy(bsp_.visibility.data(), &count, 4);
        for (size_t from = 0; from < component.size(); from++) {
            const uint32_t offset = uint32_t(bsp_.visibility.size());
            std::memcpy(bsp_.visibility.data() + 4 + 8 * from, &offset, 4);
            std::memcpy(bsp_.visibility.data() + 8 + 8 * from, &offset, 4);
            for (size_t first = 0; first < component.size(); first += 8) {
                uint8_t bits = 0;
                for (size_t k = 0; k < 8 && first + k < component.size(); k++)
                    bits = uint8_t(bits | (component[first + k] == component[from]) << k);
                bsp_.visibility.push_back(bits);
                if (bits == 0)
                    bsp_.visibility.push_back(1);
            }
        }
    }

    int size_;
    const std::vector<bool>& open_;
    Bsp bsp_;
    std::vector<size_t> leaf_of_cell_;
};

// What a map compiler's visibility cannot see through where it begins or ends: solid, and liquids that are not
// see-through.
uint32_t opaque_contents(uint32_t contents)
{
    constexpr uint32_t visible = formats::CONTENTS_SOLID | formats::CONTENTS_WINDOW | formats::CONTENTS_AUX
        | formats::CONTENTS_LAVA | formats::CONTENTS_SLIME | formats::CONTENTS_WATER | formats::CONTENTS_MIST;
    return contents & (formats::CONTENTS_TRANSLUCENT | formats::CONTENTS_DETAIL) ? 0 : contents & visible;
}

// True if all leaves between a and b have these opaque contents.
bool is_segment_within(const Bsp& bsp, int32_t child, glm::vec3 a, glm::vec3 b, uint32_t contents)
{
    while (child >= 0) {
        const formats::BspNode& node = bsp.nodes[size_t(child)];
        const formats::BspPlane& plane = bsp.planes[size_t(node.plane)];
        const float ha = glm::dot(plane.normal, a) - plane.dist, hb = glm::dot(plane.normal, b) - plane.dist;
        if (ha >= 0 && hb >= 0) {
            child = node.children[0];
        } else if (ha < 0 && hb < 0) {
            child = node.children[1];
        } else {
            const glm::vec3 middle = a + (b - a) * (ha / (ha - hb));
            const int near_side = ha < 0;
            if (!is_segment_within(bsp, node.children[near_side], a, middle, contents))
                return false;
            child = node.children[1 - near_side];
            a = middle;
        }
    }
    return opaque_contents(bsp.leaves[size_t(-1 - child)].contents) == contents;
}

} // namespace

Bsp make_cell_map(int size, const std::vector<bool>& open) { return CellMapBuilder(size, open).build(); }

std::vector<bool> make_random_cells(int size, double open_share, uint32_t seed)
{
    std::mt19937 rng(seed);
    std::vector<bool> open(size_t(size * size));
    for (size_t i = 0; i < open.size(); i++)
        open[i] = double(rng() % 1000) < 1000 * open_share;
    return open;
}

size_t add_face(Bsp& bsp, const std::vector<glm::vec3>& outline, glm::vec3 normal, uint32_t texinfo)
{
    formats::BspFace face {};
    face.plane = uint32_t(bsp.planes.size());
    bsp.planes.push_back({ normal, glm::dot(normal, outline[0]), 3 });
    face.first_edge = int32_t(bsp.surface_edges.size());
    face.edge_count = uint32_t(outline.size());
    face.texinfo = texinfo;
    face.light_offset = -1;
    const size_t first_vertex = bsp.vertices.size();
    for (size_t i = 0; i < outline.size(); i++) {
        bsp.vertices.push_back(outline[outline.size() - 1 - i]); // clockwise on disk
        bsp.surface_edges.push_back(int32_t(bsp.edges.size()));
        bsp.edges.push_back({ { uint32_t(first_vertex + i), uint32_t(first_vertex + (i + 1) % outline.size()) } });
    }
    bsp.faces.push_back(face);
    return bsp.faces.size() - 1;
}

bool is_line_clear(const Bsp& bsp, glm::vec3 a, glm::vec3 b)
{
    const int32_t root = bsp.models.empty() ? 0 : bsp.models[0].head_node;
    const uint32_t contents = opaque_contents(bsp.leaves[bsp.find_leaf(a, root)].contents);
    return !(contents & formats::CONTENTS_SOLID) && is_segment_within(bsp, root, a, b, contents);
}

} // namespace vkpt::test
