# SPDX-License-Identifier: GPL-2.0-or-later
# Included by ctest before it runs: makes an entry of every suite that a GoogleTest program has, so that a suite's cases
# share one process and what it has set up. The including file sets
#   program, runner, results   paths
#   name                       the program's, for messages
#   filter                     which cases (a GoogleTest filter), cpu_seconds  the limit of an entry, properties  of entries
if(NOT EXISTS "${program}")
    add_test("${name}_NOT_BUILT" "${program}")
    return()
endif()
execute_process(COMMAND "${program}" --gtest_list_tests "--gtest_filter=${filter}"
    OUTPUT_VARIABLE listed ERROR_VARIABLE errors RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${name} does not list its tests (${status}):\n${listed}${errors}")
endif()
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}") # what parameters are
string(REPLACE "\n" ";" lines "${listed}")
set(suites "")
foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ]+)\\. *$")
        set(suite "${CMAKE_MATCH_1}")
        list(APPEND suites "${suite}")
        set("cases of ${suite}" "")
    elseif(line MATCHES "^  ([^ ]+)")
        list(APPEND "cases of ${suite}" "${suite}.${CMAKE_MATCH_1}")
    endif()
endforeach()
foreach(suite IN LISTS suites)
    set(cases "${suite}.*")
    if(NOT filter STREQUAL "*")
        list(JOIN "cases of ${suite}" ":" cases)
    endif()
    set(entry "${name}.${suite}${ending}")
    add_test("${entry}" "${runner}" "${entry}" "${cpu_seconds}" "${results}" "${program}" "--gtest_filter=${cases}")
    set_tests_properties("${entry}" PROPERTIES ${properties})
endforeach()
