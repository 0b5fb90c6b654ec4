# SPDX-License-Identifier: GPL-2.0-or-later
# Images: finding and decoding them (vkpt_texture_files: no engine, no GPU) and holding them on the device (sources).
find_package(fmt REQUIRED)
add_library(vkpt_texture_files STATIC
    ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/bright_parts.cpp ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/normal_maps.cpp
    ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/texture_files.cpp
    ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/physical_sky.cpp ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/sky_sun.cpp)
set_target_properties(vkpt_texture_files PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(vkpt_texture_files PUBLIC vkpt_formats PRIVATE vkpt_build ${VKPT_FMT})

set(vkpt_textures_sources ${CMAKE_SOURCE_DIR}/ref_vkpt/scene/textures.cpp)
