# SPDX-License-Identifier: GPL-2.0-or-later
# The engine's side of a refresh module. ref_vkpt/CMakeLists.txt includes this and calls vkpt_add_engine(ref_vkpt).
find_package(fmt REQUIRED)

set(vkpt_engine_folder ${CMAKE_CURRENT_LIST_DIR})
cmake_path(GET vkpt_engine_folder PARENT_PATH vkpt_module_folder)
set(vkpt_engine_door_sources
    ${vkpt_engine_folder}/engine.cpp
    ${vkpt_engine_folder}/exports.cpp)
set(vkpt_engine_sources
    ${vkpt_engine_door_sources}
    ${vkpt_engine_folder}/extension_door.cpp
    ${vkpt_module_folder}/cvars.cpp)

# Gives a MODULE library the engine's entry points. Only GetRefAPI and vkpt_extension leave it, whatever its libraries show; and
# nothing may stay unresolved.
function(vkpt_add_engine_door target)
    target_sources(${target} PRIVATE ${vkpt_engine_door_sources})
    # GetRefAPI returns a C++ class on purpose (see ReturnedTable).
    set_source_files_properties(${vkpt_engine_folder}/exports.cpp PROPERTIES
        COMPILE_OPTIONS "$<$<CXX_COMPILER_ID:Clang>:-Wno-return-type-c-linkage>")
    target_link_libraries(${target} PRIVATE vkpt_build vkpt_formats ${VKPT_FMT} ${CMAKE_DL_LIBS})
    set(map ${vkpt_engine_folder}/exports.map)
    target_link_options(${target} PRIVATE "LINKER:--version-script=${map}" "LINKER:-z,defs")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
endfunction()

# The same, with the module's cvars and its extension.
function(vkpt_add_engine target)
    vkpt_add_engine_door(${target})
    target_sources(${target} PRIVATE ${vkpt_engine_sources})
endfunction()
