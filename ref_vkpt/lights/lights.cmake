# SPDX-License-Identifier: GPL-2.0-or-later
# Emitters and light lists: a static library of its own, so that tests and tools can use it without Vulkan.
add_library(vkpt_lights STATIC
    ${CMAKE_CURRENT_LIST_DIR}/animated_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/back_to_back.cpp
    ${CMAKE_CURRENT_LIST_DIR}/cluster_finder.cpp
    ${CMAKE_CURRENT_LIST_DIR}/dynamic_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/emitters.cpp
    ${CMAKE_CURRENT_LIST_DIR}/face_pieces.cpp
    ${CMAKE_CURRENT_LIST_DIR}/face_triangles.cpp
    ${CMAKE_CURRENT_LIST_DIR}/guides.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_aim.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_entities.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_cache.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_lists.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_multisets.cpp
    ${CMAKE_CURRENT_LIST_DIR}/light_trees.cpp
    ${CMAKE_CURRENT_LIST_DIR}/ltc_table.cpp
    ${CMAKE_CURRENT_LIST_DIR}/media.cpp
    ${CMAKE_CURRENT_LIST_DIR}/packed_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/point_lights.cpp
    ${CMAKE_CURRENT_LIST_DIR}/sampler_tables.cpp
    ${CMAKE_CURRENT_LIST_DIR}/suns.cpp
    ${CMAKE_CURRENT_LIST_DIR}/triangulate.cpp)
find_package(fmt REQUIRED)
target_link_libraries(vkpt_lights PUBLIC vkpt_formats PRIVATE vkpt_entity_geometry vkpt_build ${VKPT_FMT})
target_include_directories(vkpt_lights PUBLIC ${CMAKE_CURRENT_LIST_DIR}/../..)
