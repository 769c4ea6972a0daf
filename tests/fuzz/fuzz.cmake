# tact_fuzz(scene_fuzz SOURCES fuzz/scene_fuzz.cpp USES scene): an entry point of fuzz/fuzz.hpp becomes
#   scene_fuzz           replays its seeds and thousands of random mutations of them; in every suite (label replay)
#   scene_fuzz_libfuzzer with TACT_FUZZ (clang): guided by coverage for TACT_FUZZ_SECONDS (environment; 10), from
#                        the same seeds
add_custom_target(fuzz_all)
function(tact_fuzz name)
    cmake_parse_arguments(arg "" "" "SOURCES;USES;SYSTEM" ${ARGN})
    if(TACT_FUZZ)
        set(tact_fuzz_coverage -fsanitize=fuzzer-no-link)
    endif()
    tact_library(${name}_target SOURCES ${arg_SOURCES} USES ${arg_USES} SYSTEM ${arg_SYSTEM})
    tact_program(${name} SOURCES fuzz/replay_main.cpp USES ${name}_target)
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 300 LABELS replay)
    if(TACT_FUZZ)
        tact_program(${name}_libfuzzer SOURCES fuzz/libfuzzer_main.cpp USES ${name}_target)
        target_link_options(${name}_libfuzzer PRIVATE -fsanitize=fuzzer)
        set_target_properties(${name}_libfuzzer PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
        add_dependencies(fuzz_all ${name} ${name}_libfuzzer)
        set(corpus ${CMAKE_BINARY_DIR}/corpus/${name})
        add_test(NAME ${name}_libfuzzer COMMAND sh -c
            "$<TARGET_FILE:${name}> --seeds ${corpus} && exec $<TARGET_FILE:${name}_libfuzzer> -max_total_time=\${TACT_FUZZ_SECONDS:-10} -rss_limit_mb=2048 -timeout=60 -print_final_stats=1 -artifact_prefix=${corpus}/ ${corpus}")
        set_tests_properties(${name}_libfuzzer PROPERTIES TIMEOUT 600 LABELS fuzz)
    endif()
endfunction()

# One list per area, so that areas grow without touching each other.
include(fuzz/ipc.cmake)
include(fuzz/scene.cmake)
include(fuzz/prep.cmake)
include(fuzz/deploy.cmake)
include(fuzz/hal.cmake)
include(fuzz/gui.cmake)
