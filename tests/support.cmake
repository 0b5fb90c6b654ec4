# SPDX-License-Identifier: GPL-2.0-or-later
# What several programs of tests and the fuzz harnesses use: compiled once.
include_guard(GLOBAL)

# Tests run for seconds: most of them take longer to optimise than that saves. What computes much says so (OPTIMIZED).
set(vkpt_test_optimization $<$<CONFIG:Release>:-O1>)

add_library(vkpt_test_tools STATIC
    ${CMAKE_CURRENT_LIST_DIR}/client/run_program.cpp
    ${CMAKE_CURRENT_LIST_DIR}/contract/mock_engine.cpp
    ${CMAKE_CURRENT_LIST_DIR}/formats/samples.cpp
    ${CMAKE_CURRENT_LIST_DIR}/lights/synthetic_bsp.cpp)
target_link_libraries(vkpt_test_tools PUBLIC vkpt_formats PRIVATE vkpt_build)
target_compile_options(vkpt_test_tools PRIVATE ${vkpt_test_optimization})
