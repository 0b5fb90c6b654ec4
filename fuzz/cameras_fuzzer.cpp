// SPDX-License-Identifier: GPL-2.0-or-later
// A file of security cameras: whatever is read is sane, and can be written and read again.
#include "formats/camera_file.hpp"
#include "fuzz/support/harness.hpp"

#include <glm/geometric.hpp>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace vkpt;
    try {
        const formats::CameraFile file = formats::read_cameras(fuzz::text_of(data, size), "input");
        fuzz::require(file.cameras.size() <= formats::max_security_cameras, "cameras have a limit");
        for (const formats::SecurityCamera& camera : file.cameras) {
            const float length = glm::length(camera.forward);
            fuzz::require(length > 0.99f && length < 1.01f, "a camera looks somewhere");
            const formats::CameraFile again = formats::read_cameras(formats::write_camera(camera), "again");
            fuzz::require(again.cameras.size() == 1, "what was written can be read");
            fuzz::require(again.cameras[0].eye == camera.eye, "at its place");
        }
    } catch (const formats::FormatError&) {
    }
    return 0;
}
