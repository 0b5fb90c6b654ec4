# SPDX-License-Identifier: GPL-2.0-or-later
# A build within the build (preset "sanitized"): what reads strangers' files once more, under the address and undefined behaviour
# sanitizers, with its unit tests and with the harnesses, which replay the seeds, fuzz/corpus and all of fuzz/findings.
include(ExternalProject)

set(sanitized_build ${CMAKE_BINARY_DIR}/sanitized)
set(sanitized_rooms formats rays lights contract)
list(JOIN sanitized_rooms "|" rooms) # ExternalProject has semicolons for itself
ExternalProject_Add(sanitized
    PREFIX ${CMAKE_BINARY_DIR}/sanitized-project
    SOURCE_DIR ${CMAKE_SOURCE_DIR}
    BINARY_DIR ${sanitized_build}
    LIST_SEPARATOR "|"
    CONFIGURE_COMMAND ${CMAKE_COMMAND} --preset sanitized -S ${CMAKE_SOURCE_DIR} -B ${sanitized_build} -DBUILD_TESTING=ON
        "-DVKPT_TEST_ROOMS=${rooms}" -DVKPT_GAME_DATA=${CMAKE_BINARY_DIR}/game/baseq2
        -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
        -DCMAKE_C_COMPILER_LAUNCHER=${CMAKE_C_COMPILER_LAUNCHER} -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
    BUILD_COMMAND ${CMAKE_COMMAND} --build ${sanitized_build} --target sanitized_programs
    BUILD_ALWAYS ON
    USES_TERMINAL_BUILD ON
    INSTALL_COMMAND ""
    EXCLUDE_FROM_ALL OFF)
add_dependencies(sanitized game_data)

# Leaks are not looked for: an engine that takes its leave by longjmp frees nothing, and the contract's tests do the same.
function(vkpt_add_sanitized_test name)
    vkpt_add_command_test(Sanitized.${name} COMMAND ${ARGN})
    set_tests_properties(Sanitized.${name} PROPERTIES ENVIRONMENT
        "ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0;UBSAN_OPTIONS=print_stacktrace=1")
endfunction()

foreach(program formats/test_formats rays/bvh_test rays/moving_geometry_test lights/map_lights_test contract/contract_test
        contract/cvars_test)
    cmake_path(GET program FILENAME name)
    vkpt_add_sanitized_test(${name} ${sanitized_build}/tests/${program} --gtest_filter=-*takes_bounded_time*)
endforeach()
vkpt_add_sanitized_test(mutators_test ${sanitized_build}/fuzz/mutators_test)

# Every harness has inputs of its own, the seeds at least; and every folder of inputs belongs to a harness.
file(GLOB folders CONFIGURE_DEPENDS LIST_DIRECTORIES ON ${CMAKE_CURRENT_LIST_DIR}/corpus/* ${CMAKE_CURRENT_LIST_DIR}/findings/*)
if(NOT folders)
    message(FATAL_ERROR "fuzz/corpus and fuzz/findings are missing: their inputs belong to the tests")
endif()
foreach(folder IN LISTS folders)
    cmake_path(GET folder FILENAME harness)
    if(NOT harness IN_LIST harnesses)
        message(FATAL_ERROR "${folder}: there is no harness of this name")
    endif()
endforeach()
foreach(harness IN LISTS harnesses)
    set(inputs ${folders})
    list(FILTER inputs INCLUDE REGEX "/${harness}$")
    vkpt_add_sanitized_test(replay_${harness}
        ${sanitized_build}/fuzz/${harness}_replay ${sanitized_build}/fuzz/seeds/${harness} ${inputs})
endforeach()
