// SPDX-License-Identifier: GPL-2.0-or-later
// A sprite: read, and its frames as triangles before a camera.
#include "formats/model.hpp"
#include "fuzz/support/harness.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    try {
        const formats::Sp2Sprite sprite = formats::read_sp2(fuzz::bytes_of(data, size), "input.sp2");
        const Axes camera = angle_vectors({ 10, 20, 30 });
        std::vector<shared::Triangle> triangles;
        for (const formats::Sp2Sprite::Frame& frame : sprite.frames)
            append_sprite(frame, { 1, 2, 3 }, camera, 0, triangles);
        for (const shared::Triangle& triangle : triangles)
            for (const glm::vec3& corner : triangle.positions)
                fuzz::require(is_sane(corner), "a sprite's corners are finite");
    } catch (const formats::FormatError&) {
    }
    return 0;
}
