# Tests of the scene file and of its contents.
tact_tests(scene_file_tests SOURCES
        unit/scene_file_test.cpp unit/scene_kinds_test.cpp unit/scene_content_test.cpp unit/scene_contour_test.cpp
        unit/scene_isosurface_test.cpp unit/scene_clashes_test.cpp unit/scene_session_test.cpp
        unit/scene_extend_test.cpp
    USES scene scene_session base SYSTEM nlohmann_json::nlohmann_json)
tact_tests(scene_density_tests SOURCES
        unit/scene_density_map_test.cpp unit/scene_density_sum_test.cpp unit/scene_density_reference_test.cpp
        unit/scene_laplacian_map_test.cpp unit/scene_subtracted_map_test.cpp unit/scene_docking_gain_test.cpp
    USES scene reference SYSTEM rapidcheck)
tact_test(unit/scene_mesh_cut_test.cpp USES scene prep_mesh SYSTEM rapidcheck)
tact_tests(scene_mesh_tests SOURCES
        unit/scene_mesh_parts_test.cpp unit/scene_progressive_mesh_test.cpp unit/scene_surface_mesh_test.cpp
        unit/scene_bone_test.cpp unit/scene_drilled_bone_test.cpp
    USES scene base prep_mesh prep_surface SYSTEM rapidcheck)
tact_tests(scene_fit_tests SOURCES
        unit/scene_fit_metrics_test.cpp unit/scene_simulated_map_test.cpp unit/scene_refine_test.cpp
        unit/scene_fit_real_test.cpp unit/scene_residue_fit_test.cpp
    USES scene prep_map prep_structure)
set_tests_properties(scene_fit_real_test PROPERTIES LABELS long)  # not under sanitizers
