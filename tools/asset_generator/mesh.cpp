// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/mesh.hpp"

#include "tools/asset_generator/tau.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>

namespace vkpt::tools {

namespace {
constexpr int cells_per_row = 8;
constexpr float margin = 0.04f; // of a cell, against bleeding

glm::vec2 atlas_position(Material material, glm::vec2 local)
{
    const glm::vec2 cell(int(material) % cells_per_row, int(material) / cells_per_row);
    return (cell + margin + local * (1 - 2 * margin)) / float(cells_per_row);
}
}

uint32_t Mesh::corner(glm::vec3 position, glm::vec3 normal, Material material, glm::vec2 local)
{
    corners_.push_back({ position, normal, atlas_position(material, local), part_ });
    return uint32_t(corners_.size() - 1);
}

void Mesh::quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, Material material)
{
    const glm::vec3 normal = glm::normalize(glm::cross(c - a, d - b));
    const uint32_t i = corner(a, normal, material, { 0, 1 });
    corner(b, normal, material, { 1, 1 });
    corner(c, normal, material, { 1, 0 });
    corner(d, normal, material, { 0, 0 });
    face(i, i + 1, i + 2);
    face(i, i + 2, i + 3);
}

void Mesh::triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, Material material)
{
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const uint32_t i = corner(a, normal, material, { 0, 1 });
    corner(b, normal, material, { 1, 1 });
    corner(c, normal, material, { 0.5f, 0 });
    face(i, i + 1, i + 2);
}

void Mesh::box(glm::vec3 low, glm::vec3 high, Material material) { tapered_box(low, high, 1, material); }

void Mesh::tapered_box(glm::vec3 low, glm::vec3 high, float taper, Material material)
{
    const glm::vec3 middle = (low + high) * 0.5f;
    const auto at = [&](int x, int y, int z) {
        const float shrink = z ? taper : 1.0f;
        return glm::vec3(middle.x + ((x ? high.x : low.x) - middle.x) * shrink,
            middle.y + ((y ? high.y : low.y) - middle.y) * shrink, z ? high.z : low.z);
    };
    quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1), material);
    quad(at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), material);
    quad(at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), material);
    quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1), material);
    quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), material);
    quad(at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0), material);
}

void Mesh::tube(
    glm::vec3 from, glm::vec3 to, float radius_from, float radius_to, Material side, Material caps, int sides)
{
    const glm::vec3 axis = glm::normalize(to - from);
    const glm::vec3 helper = std::abs(axis.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    const glm::vec3 u = glm::normalize(glm::cross(helper, axis)), v = glm::cross(axis, u);
    const auto out = [&](int i) {
        const float a = tau * float(i) / float(sides);
        return u * std::cos(a) + v * std::sin(a);
    };
    const float slope = (radius_from - radius_to) / glm::length(to - from);
    for (int i = 0; i < sides; i++) {
        const glm::vec3 d0 = out(i), d1 = out(i + 1);
        const glm::vec3 n0 = glm::normalize(d0 + axis * slope), n1 = glm::normalize(d1 + axis * slope);
        const float s0 = float(i % 4) / 4, s1 = s0 + 0.25f; // four sides span one cell
        const uint32_t first = corner(from + d0 * radius_from, n0, side, { s0, 1 });
        corner(from + d1 * radius_from, n1, side, { s1, 1 });
        corner(to + d1 * radius_to, n1, side, { s1, 0 });
        corner(to + d0 * radius_to, n0, side, { s0, 0 });
        face(first, first + 1, first + 2);
        face(first, first + 2, first + 3);
    }
    const auto cap = [&](glm::vec3 centre, float radius, glm::vec3 normal, bool flip) {
        if (radius <= 0)
            return;
        const uint32_t first = uint32_t(corners_.size());
        for (int i = 0; i < sides; i++) {
            const float a = tau * float(i) / float(sides);
            corner(centre + out(i) * radius, normal, caps, glm::vec2(std::cos(a), std::sin(a)) * 0.5f + 0.5f);
        }
        for (uint32_t i = 1; i + 1 < uint32_t(sides); i++)
            flip ? face(first, first + i + 1, first + i) : face(first, first + i, first + i + 1);
    };
    cap(from, radius_from, -axis, true);
    cap(to, radius_to, axis, false);
}

void Mesh::ball(glm::vec3 centre, glm::vec3 radii, Material material, int slices, int stacks)
{
    const uint32_t first = uint32_t(corners_.size());
    for (int stack = 0; stack <= stacks; stack++) {
        const float polar = tau * 0.5f * float(stack) / float(stacks);
        for (int slice = 0; slice <= slices; slice++) {
            const float a = tau * float(slice) / float(slices);
            const glm::vec3 d(std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), std::cos(polar));
            corner(centre + d * radii, glm::normalize(d / radii), material,
                { float(slice) / float(slices), float(stack) / float(stacks) });
        }
    }
    const uint32_t row = uint32_t(slices) + 1;
    for (uint32_t stack = 0; stack < uint32_t(stacks); stack++) {
        for (uint32_t slice = 0; slice < uint32_t(slices); slice++) {
            const uint32_t a = first + stack * row + slice;
            if (stack + 1 < uint32_t(stacks))
                face(a, a + row, a + row + 1);
            if (stack > 0)
                face(a, a + row + 1, a + 1);
        }
    }
}

void Mesh::add(const Mesh& other, const glm::mat4& placement)
{
    const uint32_t base = uint32_t(corners_.size());
    const glm::mat3 rotate(placement);
    for (Corner c : other.corners_) {
        c.position = glm::vec3(placement * glm::vec4(c.position, 1));
        c.normal = glm::normalize(rotate * c.normal);
        c.part = part_;
        corners_.push_back(c);
    }
    for (const auto& f : other.faces_)
        face(base + f[0], base + f[1], base + f[2]);
}

formats::Md2Model Mesh::build(const std::vector<Pose>& poses, const std::vector<std::string>& skins) const
{
    formats::Md2Model model;
    model.skin_width = model.skin_height = 256;
    model.skins = skins;
    for (const Corner& c : corners_)
        model.texture_coordinates.push_back(c.uv);
    for (const auto& f : faces_)
        model.indices.insert(model.indices.end(), f.begin(), f.end());
    for (const Pose& pose : poses) {
        formats::Md2Model::Frame frame { pose.name, {}, {}, glm::vec3(1e9f), glm::vec3(-1e9f) };
        for (const Corner& c : corners_) {
            const glm::mat4 m = size_t(c.part) < pose.parts.size() ? pose.parts[size_t(c.part)] : glm::mat4(1);
            const glm::vec3 position(m * glm::vec4(c.position, 1));
            frame.positions.push_back(position);
            frame.normals.push_back(glm::normalize(glm::mat3(m) * c.normal));
            frame.mins = glm::min(frame.mins, position);
            frame.maxs = glm::max(frame.maxs, position);
        }
        model.frames.push_back(std::move(frame));
    }
    return model;
}

formats::Md2Model Mesh::build_still() const { return build({ { "still", {} } }, { std::string(shared_skin) }); }

glm::mat4 move(glm::vec3 by) { return glm::translate(glm::mat4(1), by); }

glm::mat4 turn(float pitch, float yaw, float roll)
{
    glm::mat4 m = glm::rotate(glm::mat4(1), glm::radians(yaw), glm::vec3(0, 0, 1));
    m = glm::rotate(m, glm::radians(pitch), glm::vec3(0, 1, 0));
    return glm::rotate(m, glm::radians(roll), glm::vec3(1, 0, 0));
}

glm::mat4 stretch(glm::vec3 by) { return glm::scale(glm::mat4(1), by); }

void write_model(const Output& out, std::string_view path, const formats::Md2Model& model)
{
    out.write(path, formats::write_md2(model));
}

} // namespace vkpt::tools
