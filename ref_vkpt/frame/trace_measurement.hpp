// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a trace backend is on this device, in the scene that is shown.
#pragma once

#include "ref_vkpt/frame/scene_queries.hpp"

namespace vkpt {

// Nanoseconds per ray, over camera rays, diffuse bounces and shadow rays from the last view, compilation not counted.
// Takes some tens of milliseconds on a GPU. Between frames; the frame keeps its backend.
double measure_trace_backend(const SceneQueries& queries, TraceBackend backend);

} // namespace vkpt
