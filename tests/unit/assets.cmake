# Tests of assets.
tact_test(unit/assets_scene_file_test.cpp USES assets)
tact_test(unit/assets_scene_content_test.cpp USES assets)
tact_test(unit/assets_density_map_test.cpp USES assets)
tact_test(unit/assets_density_sum_test.cpp USES assets SYSTEM rapidcheck)
tact_test(unit/assets_isosurface_test.cpp USES assets)
tact_test(unit/assets_mesh_cut_test.cpp USES assets prep_mesh SYSTEM rapidcheck)
tact_test(unit/assets_fit_metrics_test.cpp USES assets)
tact_test(unit/assets_simulated_map_test.cpp USES assets)
