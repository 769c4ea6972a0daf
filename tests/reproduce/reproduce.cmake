# Reproduces tables of the READMEs from real data; skipped without the data.
find_package(nlohmann_json REQUIRED)
tact_program(docking_finds SOURCES reproduce/docking_finds.cpp
    USES base scene force prep_map prep_structure SYSTEM nlohmann_json::nlohmann_json)
set_target_properties(docking_finds PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
if(NOT TACT_SANITIZE)  # one start of one row, as a check that it runs
    add_test(NAME docking_finds COMMAND docking_finds ../shared/data/em 1 2DQJ WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(docking_finds PROPERTIES TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()
