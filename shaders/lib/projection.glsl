// SPDX-License-Identifier: GPL-2.0-or-later
// Projections of the directions before a camera on the plane of its image (pt_projection). In the plane's middle a
// unit is a radian. The formulas are in Snyder, "Map Projections: A Working Manual" (1987), but for panini: Sharpless,
// Postle and German, "Pannini: A New Projection for Rendering Wide Angle Perspective Images" (2010).
#ifndef VKPT_LIB_PROJECTION
#define VKPT_LIB_PROJECTION

#include "../shared/cvars.h"
#include "../shared/functions.h"

// Longitude to the right and latitude up, in radians from straight ahead.
vec3 direction_at(float longitude, float latitude)
{
    return vec3(sin(longitude) * cos(latitude), sin(latitude), cos(longitude) * cos(latitude));
}

// `angle`: from straight ahead. `plane` is where it lies in the plane, and gives the way it turns.
vec3 direction_around(vec2 plane, float radius, float angle)
{
    float aside = radius > 1e-6f ? sin(angle) / radius : 1.0f;
    return vec3(plane.x * aside, plane.y * aside, cos(angle));
}

// Where a place of the plane looks: to the right, up, forward. A unit vector; in perspective, of length 1 forward.
vec3 unproject(int projection, vec2 plane)
{
    const float half_turn = 3.14159265f;
    if (projection == PROJECTION_PANINI) { // from a radius behind the cylinder's axis
        float longitude = 2.0f * atan(0.5f * plane.x);
        return direction_at(longitude, atan(plane.y * 0.5f * (1.0f + cos(longitude))));
    }
    if (projection == PROJECTION_STEREOGRAPHIC) {
        float radius = length(plane);
        return direction_around(plane, radius, 2.0f * atan(0.5f * radius));
    }
    if (projection == PROJECTION_FISHEYE) {
        float radius = length(plane);
        return direction_around(plane, radius, radius < half_turn ? radius : half_turn);
    }
    if (projection == PROJECTION_CYLINDRICAL)
        return direction_at(plane.x, atan(plane.y));
    if (projection == PROJECTION_MERCATOR)
        return direction_at(plane.x, atan(sinh(plane.y)));
    if (projection == PROJECTION_EQUIRECTANGULAR)
        return direction_at(plane.x, plane.y);
    return vec3(plane.x, plane.y, 1.0f);
}

#endif
