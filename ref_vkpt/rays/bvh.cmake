# SPDX-License-Identifier: GPL-2.0-or-later
# The software trace backend's tree builder and what orders triangles for the driver's structures, a library of its own for tests
# and the bench.
add_library(vkpt_bvh STATIC
    ${CMAKE_CURRENT_LIST_DIR}/binary_tree.cpp
    ${CMAKE_CURRENT_LIST_DIR}/bvh.cpp
    ${CMAKE_CURRENT_LIST_DIR}/moving_bvh.cpp
    ${CMAKE_CURRENT_LIST_DIR}/reinsertion.cpp
    ${CMAKE_CURRENT_LIST_DIR}/triangle_groups.cpp
    ${CMAKE_CURRENT_LIST_DIR}/wide_tree.cpp)
target_link_libraries(vkpt_bvh PRIVATE vkpt_build)
