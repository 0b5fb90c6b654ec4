// SPDX-License-Identifier: GPL-2.0-or-later
// The mean of live frames.
#pragma once

#include "tests/module/session.hpp"

namespace vkpt::tests {

// Of as many frames as given. Unlike Session::accumulate() with the session's filters, and with camera rays through the
// pixels' centres where there is no anti-aliasing. `before_each` is called before each frame.
template <class Function> Radiance average_frames(Session& session, int frames, const Function& before_each)
{
    Radiance sum;
    for (int frame = 0; frame < frames; frame++) {
        before_each();
        session.draw();
        const Radiance now = session.capture();
        if (frame == 0)
            sum = now;
        else
            for (size_t i = 0; i < sum.pixels.size(); i++)
                sum.pixels[i] += now.pixels[i];
    }
    for (glm::vec3& pixel : sum.pixels)
        pixel /= float(frames);
    return sum;
}

} // namespace vkpt::tests
