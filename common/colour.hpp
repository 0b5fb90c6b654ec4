// SPDX-License-Identifier: GPL-2.0-or-later
// Colours with the primaries of sRGB (IEC 61966-2-1), encoded and linear.
#pragma once

#include <cmath>

namespace vkpt {

// From an encoded value, 0..1, to light, and back.
template <class Number> Number decode_srgb(Number encoded)
{
    return encoded <= Number(0.04045) ? encoded / Number(12.92)
                                      : std::pow((encoded + Number(0.055)) / Number(1.055), Number(2.4));
}
template <class Number> Number encode_srgb(Number linear)
{
    return linear <= Number(0.0031308) ? linear * Number(12.92)
                                       : Number(1.055) * std::pow(linear, 1 / Number(2.4)) - Number(0.055);
}

// Of linear red, green and blue (Rec. 709); as shaders/lib/bsdf.glsl has it.
template <class Number> constexpr Number luminance(Number red, Number green, Number blue)
{
    return Number(0.2126) * red + Number(0.7152) * green + Number(0.0722) * blue;
}
// `rgb`: three neighbours.
constexpr float luminance(const float* rgb) { return luminance(rgb[0], rgb[1], rgb[2]); }
// A vector with x, y and z.
template <class Vector> constexpr auto luminance(const Vector& colour) -> decltype(colour.x + colour.y + colour.z)
{
    return luminance(colour.x, colour.y, colour.z);
}

} // namespace vkpt
