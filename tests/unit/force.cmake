# Tests of force.
tact_test(unit/force_docking_test.cpp USES force)
tact_test(unit/force_docking_levels_test.cpp USES force)
tact_test(unit/force_partial_sums_test.cpp USES force SYSTEM rapidcheck)
tact_test(unit/force_clash_test.cpp USES force SYSTEM rapidcheck)
tact_test(unit/force_docking_options_test.cpp USES force)
tact_test(unit/force_surface_test.cpp USES force prep_surface prep_synthetic)
tact_test(unit/force_tool_test.cpp USES force prep_surface prep_synthetic)
tact_test(unit/force_refinement_test.cpp USES assets force prep_mesh prep_surface prep_synthetic LABELS tsan)
