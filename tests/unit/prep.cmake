# Tests of prep.
tact_tests(prep_docking_tests SOURCES
        unit/prep_map_test.cpp unit/prep_read_map_test.cpp unit/prep_structure_test.cpp unit/prep_real_files_test.cpp unit/prep_neural_gas_test.cpp
        unit/prep_synthetic_test.cpp unit/prep_bake_test.cpp unit/prep_modes_test.cpp
    USES prep_map prep_structure prep_codebook prep_synthetic prep_docking SYSTEM ZLIB::ZLIB)
tact_tests(prep_search_tests SOURCES
        unit/prep_search_test.cpp unit/prep_search_places_test.cpp unit/prep_symmetry_test.cpp
    USES prep_docking prep_search prep_search_command prep_map prep_synthetic scene)
set_tests_properties(prep_search_places_test PROPERTIES LABELS long)
tact_tests(prep_mesh_tests SOURCES
        unit/prep_contraction_test.cpp unit/prep_mesh_file_test.cpp unit/prep_clean_mesh_test.cpp
        unit/prep_forest_test.cpp unit/prep_simplify_test.cpp unit/prep_simplify_to_keep_test.cpp
        unit/prep_largest_error_test.cpp unit/prep_opposed_test.cpp
    USES prep_mesh prep_synthetic prep_mesh_file prep_surface scene SYSTEM ZLIB::ZLIB rapidcheck)
find_package(nlohmann_json REQUIRED)
tact_tests(prep_files_tests SOURCES
        unit/prep_cli_test.cpp unit/prep_export_test.cpp unit/prep_poses_file_test.cpp unit/prep_best_codebook_test.cpp
        unit/prep_field_test.cpp unit/prep_bent_test.cpp unit/prep_residue_column_test.cpp
    USES prep_modes prep_synthetic scene prep_export prep_cif prep_structure prep_input base prep_codebook prep_field SYSTEM
        nlohmann_json::nlohmann_json tact_gemmi)
target_compile_definitions(prep_files_tests PRIVATE TACT_PREP="$<TARGET_FILE:tact-prep>")
add_dependencies(prep_files_tests tact-prep)
# Two of the ten pairs; all of them take a minute and are run by hand.
add_test(NAME save_pairs_test COMMAND tests/e2e/save_pairs_test.py $<TARGET_FILE_DIR:tact-prep> 1gte 2dqj
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(save_pairs_test PROPERTIES LABELS "e2e;long" TIMEOUT 300 SKIP_RETURN_CODE 77)
add_test(NAME search_pairs_test COMMAND tests/e2e/search_pairs_test.py $<TARGET_FILE_DIR:tact-search> 1ake 1gte
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(search_pairs_test PROPERTIES LABELS "e2e;long" TIMEOUT 300 SKIP_RETURN_CODE 77)
tact_tests(prep_scan_tests SOURCES
        unit/prep_volume_test.cpp unit/prep_scan_test.cpp unit/prep_dicom_test.cpp
        unit/prep_bone_threshold_test.cpp unit/prep_patient_frame_test.cpp
        unit/prep_structures_test.cpp unit/prep_examine_test.cpp
    USES prep_drilling prep_drilling_command prep_console prep_volume prep_synthetic scene image base
    SYSTEM ZLIB::ZLIB nlohmann_json::nlohmann_json)
tact_test(unit/prep_dicom_packed_test.cpp USES prep_drilling prep_volume base)
target_link_libraries(prep_dicom_packed_test PRIVATE ${TACT_GDCM_MSFF} ${TACT_GDCM_DSED} ${TACT_GDCM_Common})
target_include_directories(prep_dicom_packed_test SYSTEM PRIVATE ${TACT_GDCM_INCLUDE})
add_test(NAME export_bone_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/export_bone_test.py $<TARGET_FILE:tact-prep>)
set_tests_properties(export_bone_test PROPERTIES TIMEOUT 300)
add_test(NAME awkward_scans_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/awkward_scans_test.py $<TARGET_FILE:tact-prep>)
set_tests_properties(awkward_scans_test PROPERTIES TIMEOUT 300)
