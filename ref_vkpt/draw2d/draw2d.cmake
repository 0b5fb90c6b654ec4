# SPDX-License-Identifier: GPL-2.0-or-later
# The 2D layer; needs the sources of textures.cmake and the library vkpt_shaders.
set(vkpt_draw2d_sources
    ${CMAKE_SOURCE_DIR}/ref_vkpt/draw2d/draw2d.cpp
    ${CMAKE_SOURCE_DIR}/ref_vkpt/draw2d/draw2d_record.cpp)
