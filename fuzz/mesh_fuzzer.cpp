// SPDX-License-Identifier: GPL-2.0-or-later
// A model of the format VKPT_MODEL as the module uses it: read, made ready, posed at and between its frames, its
// triangles and trees written.
#include "formats/model.hpp"
#include "fuzz/support/harness.hpp"
#include "fuzz/support/moving.hpp"

namespace {

using namespace vkpt;

void pose(const std::shared_ptr<const Md2Mesh>& mesh)
{
    MovingGeometry geometry;
    const Axes axes = angle_vectors({ 10, 20, 30 });
    for (const int frame : { 0, int(mesh->frame_count()) - 1, INT32_MAX, -1 }) {
        Md2Pose pose;
        pose.transform = md2_transform({ 1, 2, 3 }, { 10, 20, 30 });
        pose.frame = frame;
        pose.backlerp = 0.25f;
        if (frame < 0) {
            pose.shell_distance = powerup_shell_distance;
            pose.mirror = Mirror { { 0, 0, 0 }, axes.right };
            pose.squeeze = Squeeze { { 0, 0, 0 }, axes.forward, 0.25f, 0.5f };
        }
        geometry.add(mesh, pose, 0, 1);
    }
    MovingGeometry next = geometry;
    next.keep_previous(0, next.extent().items, geometry, 0);
    fuzz::write_moving(next);
}

std::vector<formats::Md2Model> read(formats::Bytes bytes)
{
    constexpr std::string_view kind = VKPT_MODEL;
    if (kind == "md3")
        return formats::read_md3(bytes, "input.md3");
    if (kind == "iqm")
        return formats::read_iqm(bytes, "models/input.iqm");
    return { formats::read_md2(bytes, "input.md2") };
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    try {
        for (const formats::Md2Model& model : read(fuzz::bytes_of(data, size))) {
            for (const uint32_t index : model.indices)
                fuzz::require(index < model.vertex_count(), "a model's indices are below its number of vertices");
            for (const formats::Md2Model::Frame& frame : model.frames)
                fuzz::require(
                    frame.positions.size() == model.vertex_count() && frame.normals.size() == model.vertex_count(),
                    "a frame has all vertices");
            pose(std::make_shared<Md2Mesh>(model));
        }
    } catch (const formats::FormatError&) {
    }
    return 0;
}
