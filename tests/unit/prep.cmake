# Tests of prep.
tact_test(unit/prep_map_test.cpp USES prep_map SYSTEM ZLIB::ZLIB)
tact_test(unit/prep_structure_test.cpp USES prep_structure)
tact_test(unit/prep_real_files_test.cpp USES prep_map prep_structure)
tact_test(unit/prep_neural_gas_test.cpp USES prep_codebook)
tact_test(unit/prep_docking_gain_test.cpp USES prep_gain)
tact_test(unit/prep_synthetic_test.cpp USES prep_map prep_synthetic)
tact_test(unit/prep_simplify_test.cpp USES prep_mesh SYSTEM rapidcheck)
tact_test(unit/prep_bake_test.cpp USES prep_bake prep_synthetic)
find_package(nlohmann_json REQUIRED)
tact_test(unit/prep_cli_test.cpp USES assets SYSTEM nlohmann_json::nlohmann_json)
target_compile_definitions(prep_cli_test PRIVATE TACT_PREP="$<TARGET_FILE:tact-prep>")
add_dependencies(prep_cli_test tact-prep)
tact_test(unit/prep_export_test.cpp USES prep_export prep_structure prep_input assets base SYSTEM tact_gemmi)
tact_test(unit/prep_best_codebook_test.cpp USES prep_codebook)
# Two of the ten pairs; all of them take a minute and are for a person to start.
add_test(NAME save_pairs_test COMMAND tests/e2e/save_pairs_test.py $<TARGET_FILE_DIR:tact-prep> 1gte 2dqj
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(save_pairs_test PROPERTIES LABELS e2e TIMEOUT 300 SKIP_RETURN_CODE 77)
