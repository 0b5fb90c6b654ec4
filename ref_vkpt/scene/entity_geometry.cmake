# SPDX-License-Identifier: GPL-2.0-or-later
# What moves, as triangles and trees: a library of its own for tests and the bench.
find_package(Threads REQUIRED)
add_library(vkpt_entity_geometry STATIC
    ${CMAKE_CURRENT_LIST_DIR}/brush_mesh.cpp
    ${CMAKE_CURRENT_LIST_DIR}/entity_geometry.cpp
    ${CMAKE_CURRENT_LIST_DIR}/md2_mesh.cpp
    ${CMAKE_CURRENT_LIST_DIR}/moving_geometry.cpp
    ${CMAKE_CURRENT_LIST_DIR}/placed_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/skin_lamps.cpp
    ${CMAKE_CURRENT_LIST_DIR}/../workers.cpp)
set_target_properties(vkpt_entity_geometry PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(vkpt_entity_geometry PUBLIC vkpt_formats vkpt_bvh Threads::Threads PRIVATE vkpt_build vkpt_texture_files)
