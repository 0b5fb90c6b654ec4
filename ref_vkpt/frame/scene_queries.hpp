// SPDX-License-Identifier: GPL-2.0-or-later
// What hosts ask of a view's scene beside images: irradiance at points, rays, and what the light sampler makes of one
// pixel. Between frames.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/frame/frame.hpp"

#include <cstdint>
#include <span>

namespace vkpt {

struct SceneQueries {
    Graphics& graphics;
    Frame& frame;
    View& view; // with a snapshot
    const GpuWorld& gpu_world;

    // Irradiance / pi at points, see Extension.
    void measure_irradiance(std::span<const IrradianceProbe> probes, uint32_t samples, float* rgb) const;
    // By the backend in use, see Extension. Returns the seconds of one round.
    double trace_rays(std::span<const TracedRay> rays, const TraceRequest& request, TracedHit* hits) const;
    // So many are traced by one dispatch; screen buffers are made for as many. At least as many as the window's pixels,
    // up to a million.
    uint32_t rays_at_once() const;
    // See Extension. False: the pixel is outside of the view.
    bool inspect_pixel(glm::uvec2 pixel, InspectedSurface& surface, std::span<InspectedLight> lights) const;

private:
    void trace_chunk(std::span<const TracedRay> rays, uint32_t row, const TraceRequest& request, TracedHit* hits,
        double& seconds) const;
};

} // namespace vkpt
