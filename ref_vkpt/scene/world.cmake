# SPDX-License-Identifier: GPL-2.0-or-later
# A map as the renderer sees it, a library of its own so that tests can load maps without a device.
find_package(fmt REQUIRED)
add_library(vkpt_world STATIC
    ${CMAKE_CURRENT_LIST_DIR}/fog.cpp
    ${CMAKE_CURRENT_LIST_DIR}/screens.cpp
    ${CMAKE_CURRENT_LIST_DIR}/lightmaps.cpp
    ${CMAKE_CURRENT_LIST_DIR}/map_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/material_guess.cpp
    ${CMAKE_CURRENT_LIST_DIR}/material_library.cpp
    ${CMAKE_CURRENT_LIST_DIR}/world.cpp)
target_link_libraries(vkpt_world PUBLIC vkpt_lights vkpt_entity_geometry PRIVATE vkpt_build ${VKPT_FMT})
