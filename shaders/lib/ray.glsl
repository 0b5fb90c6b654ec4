// SPDX-License-Identifier: GPL-2.0-or-later
// What is traced and what a trace returns.
#ifndef VKPT_LIB_RAY
#define VKPT_LIB_RAY

#include "../shared/trace.h"

// Meets triangles at distances in the open interval (t_min, t_max).
struct Ray {
    vec3 origin;
    vec3 direction; // unit
    float t_min;
    float t_max;
};

const float ray_far = 1e6;

// Vulkan's own ray tracing knows neither intervals that end before they begin nor what is no number; both come from
// places that lie on each other. Of such rays this makes some that meet nothing, as the software backend has them.
Ray legal_ray(Ray ray)
{
    // Written so that what is no number fails the test.
    float sum = dot(abs(ray.origin), vec3(1.0)) + dot(abs(ray.direction), vec3(1.0));
    if (sum < ray_far * ray_far && ray.t_max >= ray.t_min)
        return ray;
    return Ray(vec3(ray_far), vec3(0.0, 0.0, 1.0), 0.0, 0.0); // outside of every map
}

struct RawHit {
    uint triangle; // id, or TRACE_MISS
    float t; // distance in lengths of `direction`; of a miss: the distance up to which nothing was met
    vec2 barycentrics; // weights of the triangle's second and third corner
    uint front; // 1: the ray came from the side that cross(p1 - p0, p2 - p0) points to
};

// The hit of a ray that has met nothing up to t_max.
RawHit no_hit(float t_max) { return RawHit(TRACE_MISS, t_max, vec2(0.0), 0u); }

#endif
