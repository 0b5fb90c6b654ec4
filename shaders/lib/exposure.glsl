// SPDX-License-Identifier: GPL-2.0-or-later
// The view's exposure, for passes that only read it: until `exposure` has run, the last view's. After frame.glsl.
#ifndef VKPT_LIB_EXPOSURE
#define VKPT_LIB_EXPOSURE

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ExposureBuffer { ExposureState v; };

// 1 as long as no image has been measured.
float image_exposure()
{
    ExposureBuffer exposure = ExposureBuffer(frame.exposure);
    return exposure.v.valid != 0u ? exposure.v.exposure : 1.0;
}

#endif
