// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/md2_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>

namespace vkpt {

namespace {

// p -> matrix * p + offset
struct Affine {
    glm::dmat3 matrix { 1 };
    glm::dvec3 offset { 0 };
    glm::dvec3 point(glm::dvec3 p) const { return matrix * p + offset; }
};

// Scales by `factor` along the unit vector `axis`, and by `across` in every direction square to it, about `centre`.
Affine scale_about(glm::dvec3 centre, glm::dvec3 axis, double factor, double across)
{
    const glm::dmat3 matrix = glm::dmat3(across) + (factor - across) * glm::outerProduct(axis, axis);
    return { matrix, centre - matrix * centre };
}

Affine compose(const Affine& outer, const Affine& inner)
{
    return { outer.matrix * inner.matrix, outer.point(inner.offset) };
}

Affine find_placing(const Md2Pose& pose)
{
    Affine placing { glm::dmat3(pose.transform.rotation), glm::dvec3(pose.transform.origin) };
    if (pose.mirror)
        placing = compose(scale_about(pose.mirror->point, pose.mirror->normal, -1, 1), placing);
    if (const auto& squeeze = pose.squeeze)
        placing = compose(
            scale_about(squeeze->eye, squeeze->forward, double(squeeze->along), double(squeeze->across)), placing);
    return placing;
}

glm::mat3 find_normal_turn(const Md2Pose& pose)
{
    const glm::dmat3 turn(pose.transform.rotation);
    return glm::mat3(pose.mirror ? scale_about({}, pose.mirror->normal, -1, 1).matrix * turn : turn);
}

// Three vectors of four.
struct Lanes3 {
    Float4 x, y, z;
};
Lanes3 load(const Float4* data) { return { data[0], data[1], data[2] }; }
Lanes3 mix(const Lanes3& a, const Lanes3& b, Float4 t)
{
    const Float4 s = 1.0f - t;
    return { a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t };
}
Lanes3 operator*(const glm::mat3& m, const Lanes3& v)
{
    return { m[0].x * v.x + m[1].x * v.y + m[2].x * v.z, m[0].y * v.x + m[1].y * v.y + m[2].y * v.z,
        m[0].z * v.x + m[1].z * v.y + m[2].z * v.z };
}
Float4 dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Float4 absolute(Float4 v) { return v < 0.0f ? -v : v; }

Int4 to_snorm16(Float4 v)
{
    const Float4 scaled = lower(higher(v, splat(-1.0f)), splat(1.0f)) * 32767.0f;
    return __builtin_convertvector(scaled + (v < 0.0f ? splat(-0.5f) : splat(0.5f)), Int4);
}

// encode_octahedral() of four.
Int4 encode_four_octahedral(const Lanes3& d)
{
    const Float4 length = absolute(d.x) + absolute(d.y) + absolute(d.z);
    const Float4 inverse = length > 1e-12f ? 1.0f / length : splat(0.0f);
    const Float4 x = d.x * inverse, y = d.y * inverse;
    const Float4 folded_x = (1.0f - absolute(y)) * (x >= 0.0f ? splat(1.0f) : splat(-1.0f));
    const Float4 folded_y = (1.0f - absolute(x)) * (y >= 0.0f ? splat(1.0f) : splat(-1.0f));
    const Int4 below = d.z < 0.0f;
    return (to_snorm16(below ? folded_x : x) & 0xffff) | (to_snorm16(below ? folded_y : y) << 16);
}

} // namespace

Md2Mesh::Md2Mesh(const formats::Md2Model& model)
    : point_count_(model.vertex_count())
{
    frames_.reserve(model.frames.size());
    for (const formats::Md2Model::Frame& frame : model.frames)
        frames_.push_back(make_frame(frame, point_count_));
    make_tree(model);
}

Md2Mesh::Frame Md2Mesh::make_frame(const formats::Md2Model::Frame& source, size_t points)
{
    Frame frame;
    frame.data.resize((points + 3) / 4 * 6, splat(0.0f));
    frame.usable = points > 0;
    for (size_t i = 0; i < points; i++) {
        const glm::vec3 p = source.positions[i], n = source.normals[i];
        Float4* group = &frame.data[i / 4 * 6];
        for (int axis = 0; axis < 3; axis++) {
            group[axis][i % 4] = p[axis];
            group[axis + 3][i % 4] = n[axis];
        }
        frame.box.add(p);
        frame.usable &= is_sane(p) && is_sane(n);
    }
    return frame;
}

void Md2Mesh::make_tree(const formats::Md2Model& model)
{
    const auto rest = std::ranges::find_if(frames_, &Frame::usable);
    if (rest == frames_.end())
        return;
    // For one pose, and refitted in all others: among players in all poses it traces at 0.96 times the speed of a tree
    // made anew for each frame, and 1.35 times that of the quick one. Made for the boxes of sixteen frames at once:
    // 0.83 and 1.16.
    const std::vector<glm::vec3>& positions = model.frames[size_t(rest - frames_.begin())].positions;
    std::vector<Box> boxes(model.triangle_count());
    for (size_t i = 0; i < boxes.size() * 3; i++)
        boxes[i / 3].add(positions[model.indices[i]]);
    if (boxes.size() <= max_mesh_triangles)
        tree_ = build_mesh_tree(boxes);
    else {
        tree_.order.resize(boxes.size());
        std::iota(tree_.order.begin(), tree_.order.end(), 0u);
    }
    for (const uint32_t triangle : tree_.order) {
        const uint32_t* from = &model.indices[size_t(triangle) * 3];
        corners_.insert(corners_.end(), from, from + 3);
        uvs_.push_back({ model.texture_coordinates[from[0]], model.texture_coordinates[from[1]],
            model.texture_coordinates[from[2]] });
    }
}

const Md2Mesh::Frame& Md2Mesh::pick(int frame) const
{
    return frames_[size_t(std::clamp(frame, 0, int(frames_.size()) - 1))];
}

Md2Mesh::Blend Md2Mesh::find_blend(const Md2Pose& pose) const
{
    const float backlerp = pose.backlerp > 0 ? std::min(pose.backlerp, 1.0f) : 0; // NaN: 0
    const Frame& frame = pick(pose.frame);
    return { &frame, backlerp > 0 ? &pick(pose.old_frame) : &frame, backlerp };
}

bool Md2Mesh::can_pose(const Md2Pose& pose) const
{
    if (frames_.empty() || !is_sane(pose.transform))
        return false;
    if (pose.mirror && !(is_sane(pose.mirror->point) && is_sane(pose.mirror->normal)))
        return false;
    if (const auto& squeeze = pose.squeeze; squeeze
        && !(is_sane(squeeze->eye) && is_sane(squeeze->forward) && is_sane(squeeze->along) && is_sane(squeeze->across)))
        return false;
    const Blend blend = find_blend(pose);
    return blend.frame->usable && blend.old_frame->usable;
}

Box Md2Mesh::bounds(const Md2Pose& pose) const
{
    const Blend blend = find_blend(pose);
    Box box = blend.frame->box;
    box.add(blend.old_frame->box);
    const float shell = is_sane(pose.shell_distance) ? std::abs(pose.shell_distance) : 0;
    const glm::dvec3 half = glm::dvec3(box.high - box.low) * 0.5 + double(shell);
    const Affine placing = find_placing(pose);
    const glm::dvec3 centre = placing.point(glm::dvec3(box.centre()));
    glm::dvec3 reach(0);
    for (int column = 0; column < 3; column++)
        reach += glm::abs(placing.matrix[column]) * half[column];
    reach += 1e-6 * (glm::abs(centre) + reach); // for the rounding in pose()
    return { glm::vec3(centre - reach), glm::vec3(centre + reach) };
}

void Md2Mesh::pose(const Md2Pose& pose, std::vector<Float4>& points) const
{
    const Blend blend = find_blend(pose);
    const Affine placing = find_placing(pose);
    const glm::mat3 matrix(placing.matrix), normal_turn = find_normal_turn(pose);
    const glm::vec3 offset(placing.offset);
    const float shell = is_sane(pose.shell_distance) ? pose.shell_distance : 0;
    const Float4 backlerp = splat(blend.backlerp);
    const size_t groups = (point_count_ + 3) / 4;
    points.resize(std::max(points.size(), groups * 4));
    for (size_t group = 0; group < groups; group++) {
        const Float4 *a = &blend.frame->data[group * 6], *b = &blend.old_frame->data[group * 6];
        const Lanes3 new_normal = load(a + 3);
        Lanes3 p = mix(load(a), load(b), backlerp), n = mix(new_normal, load(b + 3), backlerp);
        const Float4 square = dot(n, n);
        const Int4 cancels = square <= 1e-24f; // opposite normals: the new frame's
        n = { cancels ? new_normal.x : n.x, cancels ? new_normal.y : n.y, cancels ? new_normal.z : n.z };
        if (shell != 0) {
            Float4 push;
            for (int lane = 0; lane < 4; lane++)
                push[lane] = shell / (cancels[lane] ? 1.0f : std::sqrt(square[lane]));
            p = { p.x + n.x * push, p.y + n.y * push, p.z + n.z * push };
        }
        const Lanes3 world = matrix * p;
        const Float4 x = world.x + offset.x, y = world.y + offset.y, z = world.z + offset.z;
        const Float4 normal = Float4(encode_four_octahedral(normal_turn * n)); // the bits
        for (int lane = 0; lane < 4; lane++)
            points[group * 4 + size_t(lane)] = Float4 { x[lane], y[lane], z[lane], normal[lane] };
    }
}

} // namespace vkpt
