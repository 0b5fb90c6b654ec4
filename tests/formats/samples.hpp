// SPDX-License-Identifier: GPL-2.0-or-later
// Small valid files of every format, made by the tests themselves.
#pragma once

#include "formats/bsp.hpp"
#include "formats/image.hpp"
#include "formats/model.hpp"
#include "formats/model_iqm.hpp"

#include <vector>

namespace vkpt::samples {

// A floor of two squares under two leaves (cluster 0 at x < 0, cluster 1 at x > 0; each sees only itself), solid below
// z = 0.
formats::Bsp make_bsp();
formats::IndexedImage make_indexed_image(int width, int height); // runs, noise, and indices 192..255
formats::Image make_image(int width, int height);
formats::Md2Model make_md2(); // a tetrahedron with a texture seam, two frames
formats::IqmModel make_iqm(); // an arm along z with its elbow at 20, and its hand, another mesh; straight, then bent
std::vector<formats::Md2Model> make_md3(); // two surfaces, the second below the first; two frames
formats::Sp2Sprite make_sp2();
std::vector<std::byte> make_m8(); // 8 x 4, name "walls/m8"
std::vector<std::byte> make_m32(); // 8 x 4, name "walls/m32"
std::vector<std::byte> make_jpg(int width, int height);
std::vector<std::byte> make_packed_tga(); // run-length encoded, 24 bits, bottom up, 5 x 3

} // namespace vkpt::samples
