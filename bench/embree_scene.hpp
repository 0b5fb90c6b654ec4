// SPDX-License-Identifier: GPL-2.0-or-later
// Embree's single-ray functions on one thread, for comparison. Only where Embree 3 is installed (VKPT_HAVE_EMBREE).
#pragma once

#ifdef VKPT_HAVE_EMBREE
#include "ref_vkpt/rays/bvh.hpp"
#include "tests/rays/trace_rays.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <span>

namespace vkpt::tests {

class EmbreeScene {
public:
    explicit EmbreeScene(std::span<const BvhTriangle> triangles)
        : device_(rtcNewDevice("threads=1"))
        , scene_(rtcNewScene(device_))
    {
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), triangles.size() * 3));
        auto* indices = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()));
        for (size_t i = 0; i < triangles.size() * 3; i++) {
            corners[i] = triangles[i / 3].positions[i % 3];
            indices[i] = uint32_t(i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // How many rays met something.
    size_t trace(std::span<const shared::TestRay> rays, bool any_hit) const
    {
        size_t met = 0;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (const shared::TestRay& ray : rays) {
            RTCRayHit query {};
            query.ray = { ray.origin.x, ray.origin.y, ray.origin.z, ray.t_min, ray.direction.x, ray.direction.y,
                ray.direction.z, 0.0f, ray.t_max, ~0u, 0, 0 };
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            if (any_hit)
                rtcOccluded1(scene_, &context, &query.ray);
            else
                rtcIntersect1(scene_, &context, &query);
            met += any_hit ? query.ray.tfar < 0.0f : query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
        return met;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace vkpt::tests
#endif
