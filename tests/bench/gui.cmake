# Benches of gui.
if(TACT_GUI)
    tact_bench(bench/draw_bench.cpp USES gui_app gui_panels gui_render scene base)
    tact_bench(bench/bone_bench.cpp USES gui_app gui_panels gui_render prep_synthetic scene base)
    tact_bench(bench/cloud_bench.cpp USES gui_app gui_panels gui_particles gui_render prep_mesh scene base)
    tact_bench(bench/particles_bench.cpp USES gui_particles scene base)
endif()
