# Checks of the source itself. deploy/test also checks the formatting.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
    add_test(NAME tidy_layers COMMAND ${Python3_EXECUTABLE} tests/tidy/layers.py WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_layers_finds_violations COMMAND ${Python3_EXECUTABLE} tests/tidy/layers.py --self-test
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_systems COMMAND ${Python3_EXECUTABLE} tests/tidy/systems.py WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_systems_finds_violations COMMAND ${Python3_EXECUTABLE} tests/tidy/systems.py --self-test
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_servo_words COMMAND ${Python3_EXECUTABLE} tests/tidy/servo_words.py WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_servo_words_finds_violations COMMAND ${Python3_EXECUTABLE} tests/tidy/servo_words.py --self-test
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_mutants COMMAND ${Python3_EXECUTABLE} tests/mutants/run --check WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(tidy_mutants PROPERTIES LABELS tidy)
    add_test(NAME tidy_words COMMAND ${Python3_EXECUTABLE} tests/tidy/words.py WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_words_finds_violations COMMAND ${Python3_EXECUTABLE} tests/tidy/words.py --self-test
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(tidy_words tidy_words_finds_violations PROPERTIES LABELS tidy)
    set_tests_properties(tidy_layers tidy_layers_finds_violations tidy_systems tidy_systems_finds_violations
        tidy_servo_words tidy_servo_words_finds_violations
        PROPERTIES LABELS tidy)
endif()
# Checks the shipped machine code: a build for x86-64 with optimization and without sanitizers.
if(Python3_FOUND AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT TACT_SANITIZE AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    add_test(NAME tidy_hot_symbols COMMAND ${Python3_EXECUTABLE} tests/tidy/hot_symbols.py ${CMAKE_BINARY_DIR}
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    add_test(NAME tidy_hot_symbols_finds_violations COMMAND ${Python3_EXECUTABLE} tests/tidy/hot_symbols.py --self-test
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(tidy_hot_symbols tidy_hot_symbols_finds_violations PROPERTIES LABELS tidy)
endif()
