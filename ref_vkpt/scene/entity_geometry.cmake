# SPDX-License-Identifier: GPL-2.0-or-later
add_library(vkpt_entity_geometry STATIC ${CMAKE_CURRENT_LIST_DIR}/entity_geometry.cpp)
set_target_properties(vkpt_entity_geometry PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(vkpt_entity_geometry PUBLIC vkpt_formats PRIVATE vkpt_build)
