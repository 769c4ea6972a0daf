# Tests of gui.
if(TACT_GUI)
    find_package(CLI11 REQUIRED)
    tact_test(unit/gui_plot_series_test.cpp USES gui_panels)
    tact_test(unit/gui_dashboard_test.cpp USES gui_panels topics base)
    tact_test(unit/gui_particles_test.cpp USES gui_particles assets base)
    tact_test(scenario/site_scenario_test.cpp USES gui_site gui_link gui_particles topics shm assets hal force loop base)
    tact_test(unit/gui_site_test.cpp USES gui_site gui_link gui_particles topics shm assets base
        SYSTEM nlohmann_json::nlohmann_json)
    tact_test(unit/gui_cloud_test.cpp USES gui_app gui_particles gui_panels gui_render launch assets base
        TIMEOUT 300)
    tact_test(unit/gui_drilling_test.cpp USES gui_drilling topics shm assets base SYSTEM nlohmann_json::nlohmann_json)
    tact_test(unit/gui_bone_test.cpp USES gui_app gui_render topics shm assets base)
    tact_test(unit/gui_bone_draw_test.cpp USES gui_app gui_panels gui_render launch assets base TIMEOUT 300)
    tact_test(unit/gui_view_test.cpp USES gui_render prep_mesh topics shm assets base)
    tact_test(unit/gui_stage_test.cpp USES gui_stage gui_render topics base)
    tact_test(unit/gui_link_test.cpp USES gui_link gui_panels topics shm base)
    tact_test(unit/gui_bone_follower_test.cpp USES gui_link topics shm assets base)
    tact_test(unit/gui_history_test.cpp USES gui_fit base SYSTEM rapidcheck)
    tact_test(unit/gui_fit_test.cpp USES gui_fit gui_render prep_mesh topics shm assets base)
    tact_test(unit/gui_window_test.cpp USES launch prep_mesh topics shm assets base SYSTEM PNG::PNG TIMEOUT 900)
    target_compile_definitions(gui_window_test PRIVATE TACT_GUI_PROGRAM="$<TARGET_FILE:tact-gui>")
    add_dependencies(gui_window_test tact-gui)
    set_tests_properties(gui_window_test PROPERTIES RUN_SERIAL ON)
    tact_test(unit/gui_shapes_test.cpp USES gui_render prep_surface prep_synthetic assets base)
    tact_test(unit/gui_contour_test.cpp USES gui_app gui_render prep_mesh topics shm assets base
        SYSTEM CLI11::CLI11 TIMEOUT 300)
    target_compile_definitions(gui_contour_test PRIVATE TACT_PREP="$<TARGET_FILE:tact-prep>")
    add_dependencies(gui_contour_test tact-prep)
    tact_test(unit/gui_drill_desk_test.cpp USES gui_app gui_drilling gui_link gui_panels gui_render prep_mesh topics shm assets base
        SYSTEM nlohmann_json::nlohmann_json CLI11::CLI11)
    tact_test(unit/gui_draw_test.cpp USES gui_app gui_panels gui_stage gui_render launch prep_mesh topics shm assets base
        TIMEOUT 300)
endif()
