# tact_bench(bench/ipc_bench.cpp USES shm topics): a Google Benchmark program in build/<preset>/bench. Sanitized builds
# have none, because their times mean nothing. CTest only checks that each still runs (label bench).
find_package(benchmark REQUIRED)
function(tact_bench source)
    if(TACT_SANITIZE)
        return()
    endif()
    cmake_parse_arguments(arg "" "" "USES;SYSTEM;EXTRA" ${ARGN})
    get_filename_component(name ${source} NAME_WE)
    tact_program(${name} SOURCES ${source} ${arg_EXTRA} USES ${arg_USES}
        SYSTEM ${arg_SYSTEM} benchmark::benchmark benchmark::benchmark_main)
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
    add_test(NAME ${name} COMMAND ${name} --benchmark_min_time=0.001 WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(${name} PROPERTIES TIMEOUT 300 LABELS bench)
endfunction()

# One list per area, so that areas grow without touching each other.
include(bench/ipc.cmake)
include(bench/scene.cmake)
include(bench/prep.cmake)
include(bench/force.cmake)
include(bench/rt.cmake)
include(bench/gui.cmake)
include(bench/deploy.cmake)
