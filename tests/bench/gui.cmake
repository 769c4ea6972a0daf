# Benches of gui.
if(TACT_GUI)
    tact_bench(bench/draw_bench.cpp USES gui_app gui_panels gui_render assets base)
    tact_bench(bench/bone_bench.cpp USES gui_app gui_panels gui_render prep_synthetic assets base)
    tact_bench(bench/cloud_bench.cpp USES gui_app gui_panels gui_particles gui_render prep_mesh assets base)
    tact_bench(bench/particles_bench.cpp USES gui_particles assets base)
endif()
