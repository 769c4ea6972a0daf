# Tests of force.
tact_tests(force_docking_tests SOURCES
        unit/force_fade_test.cpp unit/force_docking_levels_test.cpp unit/force_docking_stiffness_test.cpp
        unit/force_partial_sums_test.cpp unit/force_clash_test.cpp unit/force_docking_options_test.cpp
        unit/force_basin_pull_test.cpp unit/force_together_test.cpp
    USES force scene reference SYSTEM rapidcheck)
tact_test(unit/force_flexible_test.cpp USES force scene prep_codebook prep_modes prep_synthetic)
tact_test(unit/force_docking_test.cpp USES force)
tact_tests(force_surface_tests SOURCES
        unit/force_surface_test.cpp unit/force_surface_modes_test.cpp unit/force_surface_settled_test.cpp
        unit/force_surface_energy_test.cpp unit/force_stick_slip_test.cpp
    USES force prep_surface prep_synthetic prep_mesh_file reference)
tact_test(unit/force_surface_slide_test.cpp USES force prep_surface prep_synthetic)
tact_test(unit/force_tool_test.cpp USES force prep_surface prep_synthetic)
tact_tests(force_tool_tests SOURCES
        unit/force_touch_tool_test.cpp unit/force_tool_modes_test.cpp unit/force_tool_rehearsal_test.cpp unit/force_tool_dense_test.cpp
        unit/force_tool_energy_test.cpp unit/force_query_record_test.cpp unit/force_tool_points_test.cpp
    USES force prep_surface prep_synthetic)
tact_tests(force_drilling_tests SOURCES
        unit/force_bone_test.cpp unit/force_drill_levels_test.cpp unit/force_drill_predict_test.cpp unit/force_drill_rehearsal_test.cpp unit/force_drill_trial_test.cpp unit/force_strokes_test.cpp unit/force_burr_exchange_test.cpp
    USES force)
tact_test(unit/force_drill_test.cpp USES force)
tact_tests(certify_tests SOURCES
        unit/certify_drilling_test.cpp unit/certify_docking_test.cpp unit/certify_surface_test.cpp
        unit/certify_tool_test.cpp
    USES certify scene prep_surface prep_synthetic prep_mesh_file)
tact_test(unit/force_refinement_test.cpp USES scene force prep_mesh prep_surface prep_synthetic LABELS tsan)
tact_test(unit/force_field_test.cpp USES base scene force prep_field)
# Not under sanitizers, where they take minutes: campaigns of numbers over code that the other tests run too.
set_tests_properties(force_docking_stiffness_test force_surface_energy_test force_surface_settled_test
    force_tool_energy_test certify_drilling_test certify_surface_test certify_tool_test PROPERTIES LABELS long)
