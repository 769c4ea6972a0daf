# Benchmarks of gui.
if(TACT_GUI)
    tact_bench(bench/draw_bench.cpp USES gui_window gui_dashboard gui_docking gui_render scene base)
    tact_bench(bench/bone_bench.cpp USES gui_window gui_dashboard gui_render prep_synthetic scene image base)
    tact_bench(bench/cloud_bench.cpp USES gui_window gui_dashboard gui_drilling_site gui_render prep_mesh scene image base)
    tact_bench(bench/particles_bench.cpp USES gui_drilling_site scene base)
endif()
