# Tests of gui.
if(TACT_GUI)
    find_package(CLI11 REQUIRED)
    tact_tests(gui_dashboard_tests SOURCES
            unit/gui_plot_series_test.cpp unit/gui_dashboard_test.cpp unit/gui_layout_test.cpp
            unit/gui_traces_test.cpp unit/gui_traces_panel_test.cpp unit/gui_trace_export_test.cpp
            unit/gui_timeline_test.cpp unit/gui_events_test.cpp unit/gui_letters_test.cpp
        USES gui_dashboard gui_window gui_docking gui_surface gui_field gui_drilling gui_link topics base)
    tact_test(unit/gui_input_test.cpp USES gui_input gui_dashboard spacenav base SYSTEM ${TACT_SPNAV_LIBRARY})
    target_include_directories(gui_input_test SYSTEM PRIVATE ${TACT_SPNAV_INCLUDE})
    tact_test(unit/gui_space_mouse_test.cpp USES gui_input gui_base spacenav base SYSTEM ${TACT_SPNAV_LIBRARY} LABELS tsan)
    target_include_directories(gui_space_mouse_test SYSTEM PRIVATE ${TACT_SPNAV_INCLUDE})
    tact_test(unit/gui_field_card_test.cpp USES gui_window gui_field gui_docking gui_dashboard topics base)
    tact_test(unit/gui_hours_test.cpp USES gui_window gui_docking gui_dashboard topics shm base TIMEOUT 300)
    tact_tests(gui_drilling_tests SOURCES
            unit/gui_particles_test.cpp unit/gui_site_test.cpp unit/gui_drilling_test.cpp unit/gui_bone_test.cpp
            unit/gui_bone_follower_test.cpp unit/gui_drill_controller_test.cpp unit/gui_burr_tray_test.cpp
            unit/gui_wet_bone_test.cpp unit/gui_bone_tiles_test.cpp
        USES gui_drilling_site threads servo scene base gui_link topics shm gui_drilling gui_render gui_window gui_dashboard
            prep_mesh SYSTEM nlohmann_json::nlohmann_json CLI11::CLI11)
    tact_test(unit/gui_drill_sound_test.cpp USES gui_drilling_sound)
    tact_test(unit/gui_training_test.cpp USES gui_drilling_training)
    tact_test(unit/gui_training_volumes_test.cpp USES gui_drilling_training scene)
    tact_test(unit/gui_first_bone_test.cpp USES gui_drilling_site scene)
    tact_test(scenario/site_scenario_test.cpp USES gui_drilling_site gui_link topics shm scene hal force servo threads config start base)
    tact_tests(gui_draw_tests SOURCES
            unit/gui_cloud_test.cpp unit/gui_detail_test.cpp unit/gui_edges_test.cpp unit/gui_bone_draw_test.cpp
            unit/gui_draw_test.cpp unit/gui_frames_test.cpp
        USES gui_window gui_drilling gui_drilling_site gui_dashboard gui_render launch scene base gui_docking prep_mesh
            topics shm gui_stereo SYSTEM nlohmann_json::nlohmann_json TIMEOUT 300)
    tact_test(unit/gui_cut_test.cpp USES gui_window gui_render gui_docking launch scene base)
    tact_test(unit/gui_press_test.cpp USES gui_window gui_dashboard launch)
    tact_test(unit/gui_light_test.cpp USES gui_window gui_render launch scene base)
    tact_test(unit/gui_output_test.cpp USES gui_window gui_dashboard gui_base base SYSTEM spdlog::spdlog)
    tact_test(unit/gui_ribbon_test.cpp USES gui_render scene SYSTEM ZLIB::ZLIB)
    tact_test(unit/gui_draw_scene_test.cpp USES gui_window gui_render launch scene base gui_docking prep_mesh topics shm
        SYSTEM nlohmann_json::nlohmann_json TIMEOUT 300)
    tact_tests(gui_docking_tests SOURCES
            unit/gui_view_test.cpp unit/gui_fit_test.cpp unit/gui_history_test.cpp unit/gui_shapes_test.cpp
            unit/gui_contour_test.cpp unit/gui_link_test.cpp unit/gui_region_checks_test.cpp
            unit/gui_status_text_test.cpp unit/gui_placement_test.cpp unit/gui_bent_test.cpp
            unit/gui_labels_test.cpp unit/gui_molecular_surface_test.cpp unit/gui_pick_test.cpp
        USES gui_docking gui_render prep_mesh topics shm scene base gui_surface prep_surface prep_synthetic gui_window
            gui_link gui_dashboard SYSTEM rapidcheck CLI11::CLI11 TIMEOUT 300)
    tact_tests(gui_stereo_tests SOURCES
            unit/gui_registration_test.cpp unit/gui_calibration_test.cpp unit/gui_stage_test.cpp
            unit/gui_stage_file_test.cpp unit/gui_test_picture_test.cpp
        USES gui_stereo base gui_render topics SYSTEM rapidcheck)
    tact_tests(gui_window_tests SOURCES
            unit/gui_calibration_window_test.cpp unit/gui_keys_window_test.cpp unit/gui_browser_window_test.cpp
            unit/gui_window_test.cpp
        USES gui_stereo gui_render launch hal tracker servo threads config topics shm base gui_system prep_mesh scene
            image TIMEOUT 900)
    target_compile_definitions(gui_window_tests PRIVATE TACT_GUI_PROGRAM="$<TARGET_FILE:tact-gui>"
        TACT_PROGRAM="$<TARGET_FILE:tact>")
    add_dependencies(gui_window_tests tact tact-gui tact-rt tact-prep tact-record)
    set_tests_properties(gui_calibration_window_test gui_keys_window_test gui_browser_window_test gui_window_test
        PROPERTIES RUN_SERIAL ON)
    tact_tests(gui_state_tests SOURCES
            unit/gui_keys_test.cpp unit/gui_mouse_test.cpp unit/gui_panel_controllers_test.cpp unit/gui_window_state_test.cpp
            unit/gui_import_test.cpp unit/gui_import_form_test.cpp unit/gui_start_page_test.cpp
        USES gui_system gui_window_files gui_dashboard gui_input topics scene image base gui_render gui_window TIMEOUT 300)
    target_compile_definitions(gui_state_tests PRIVATE TACT_FOLDER="$<TARGET_FILE_DIR:tact>")
    add_dependencies(gui_state_tests tact tact-prep)
    target_compile_definitions(gui_docking_tests PRIVATE TACT_PREP="$<TARGET_FILE:tact-prep>"
        TACT_SEARCH="$<TARGET_FILE:tact-search>" TACT_REFINE="$<TARGET_FILE:tact-refine>")
    add_dependencies(gui_docking_tests tact-prep tact-search tact-refine)
endif()
