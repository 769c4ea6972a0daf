#Tests of gui.
if (TACT_GUI)
find_package(CLI11 REQUIRED) tact_test(unit / gui_plot_series_test.cpp USES gui_dashboard) tact_test(
    unit / gui_dashboard_test.cpp USES gui_window gui_docking gui_dashboard topics
               base) tact_test(unit / gui_traces_test.cpp USES gui_dashboard topics
                                          base) tact_test(unit / gui_traces_panel_test.cpp USES gui_window
                                                                     gui_docking gui_dashboard topics base)
    tact_test(unit / gui_hours_test.cpp USES gui_window gui_docking gui_dashboard topics shm base TIMEOUT 300) tact_test(
        unit /
        gui_trace_export_test
            .cpp USES gui_dashboard
                topics base) tact_test(unit / gui_particles_test.cpp USES gui_drilling_site scene base)
        tact_test(scenario / site_scenario_test.cpp USES gui_drilling_site gui_link topics shm scene hal force servo threads config base) tact_test(
            unit /
            gui_site_test
                .cpp USES gui_drilling_site
                    gui_link topics
                        shm scene base SYSTEM
                            nlohmann_json::
                                nlohmann_json) tact_test(unit / gui_cloud_test.cpp USES gui_window gui_drilling gui_drilling_site gui_dashboard gui_render launch scene base TIMEOUT 300)
            tact_test(unit / gui_edges_test.cpp USES gui_window gui_render launch base) tact_test(
                unit /
                gui_drilling_test
                    .cpp USES gui_drilling_site
                        topics shm scene
                            base SYSTEM
                                nlohmann_json::
                                    nlohmann_json) tact_test(unit / gui_bone_test.cpp USES gui_drilling gui_render topics shm scene base)
                tact_test(unit / gui_bone_draw_test.cpp USES gui_window gui_drilling gui_dashboard gui_render launch scene base TIMEOUT 300) tact_test(
                    unit /
                    gui_view_test
                        .cpp USES gui_docking
                            gui_render prep_mesh
                                topics shm scene
                                    base) tact_test(unit / gui_registration_test.cpp USES gui_stereo base SYSTEM rapidcheck)
                    tact_test(unit / gui_calibration_test.cpp USES gui_stereo gui_render base) tact_test(
                        unit /
                        gui_calibration_window_test
                            .cpp USES gui_stereo
                                gui_render launch hal tracker
                                    servo threads config
                                        topics shm base
                                            TIMEOUT 900) target_compile_definitions(gui_calibration_window_test PRIVATE TACT_GUI_PROGRAM =
                                                                                        "$<TARGET_FILE:tact-"
                                                                                        "gui>")
                        add_dependencies(gui_calibration_window_test tact - gui) set_tests_properties(
                            gui_calibration_window_test PROPERTIES RUN_SERIAL
                                ON) tact_test(unit / gui_stage_test.cpp USES gui_stereo gui_render topics base)
                            tact_test(
                                unit /
                                gui_frames_test
                                    .cpp USES
                                        gui_window gui_dashboard
                                            gui_render launch shm topics
                                                scene base SYSTEM nlohmann_json::nlohmann_json
                                                    TIMEOUT 300)
                                tact_test(unit / gui_link_test.cpp USES gui_link gui_docking gui_render gui_dashboard topics shm base) tact_test(
                                    unit /
                                    gui_bone_follower_test
                                        .cpp USES gui_drilling_site
                                            topics shm scene
                                                base)
                                    tact_test(unit / gui_history_test.cpp USES gui_docking base SYSTEM rapidcheck) tact_test(
                                        unit /
                                        gui_fit_test
                                            .cpp USES gui_docking gui_render
                                                prep_mesh topics
                                                    shm scene
                                                        base) tact_test(unit / gui_keys_test.cpp USES gui_system)
                                        tact_test(unit / gui_panel_controllers_test.cpp USES gui_window_files gui_dashboard scene base) tact_test(
                                            unit /
                                            gui_window_state_test
                                                .cpp USES gui_window_files gui_dashboard
                                                    gui_render base)
                                            tact_test(
                                                unit /
                                                gui_keys_window_test
                                                    .cpp USES
                                                        gui_system launch
                                                            prep_mesh topics
                                                                shm scene base TIMEOUT 300)
                                                target_compile_definitions(
                                                    gui_keys_window_test PRIVATE TACT_GUI_PROGRAM =
                                                        "$<TARGET_FILE:tact-gui>") add_dependencies(gui_keys_window_test
                                                                                                        tact -
                                                                                                    gui)
                                                    set_tests_properties(gui_keys_window_test PROPERTIES RUN_SERIAL ON) tact_test(
                                                        unit /
                                                        gui_browser_window_test
                                                            .cpp USES launch
                                                                prep_mesh topics
                                                                    shm scene
                                                                        base TIMEOUT 600) target_compile_definitions(gui_browser_window_test PRIVATE
                                                                                                                         TACT_PROGRAM =
                                                                                                                             "$<TARGET_FILE:tact>")
                                                        add_dependencies(
                                                            gui_browser_window_test
                                                                tact tact -
                                                            gui tact - rt tact -
                                                            prep) set_tests_properties(gui_browser_window_test PROPERTIES RUN_SERIAL ON)
                                                            tact_test(
                                                                unit /
                                                                gui_import_test
                                                                    .cpp USES
                                                                        gui_window gui_window_files
                                                                            gui_dashboard
                                                                                scene base TIMEOUT 300)
                                                                target_compile_definitions(
                                                                    gui_import_test
                                                                        PRIVATE
                                                                            TACT_FOLDER =
                                                                                "$<TARGET_FILE_DIR:tact>")
                                                                    add_dependencies(gui_import_test tact tact - prep) tact_test(
                                                                        unit /
                                                                        gui_window_test
                                                                            .cpp USES launch
                                                                                prep_mesh topics
                                                                                    shm scene base SYSTEM
                                                                                        PNG::PNG TIMEOUT 900)
                                                                        target_compile_definitions(
                                                                            gui_window_test
                                                                                PRIVATE TACT_GUI_PROGRAM =
                                                                                    "$<TARGET_FILE:tact-gui>")
                                                                            add_dependencies(gui_window_test
                                                                                                 tact -
                                                                                             gui)
                                                                                set_tests_properties(
                                                                                    gui_window_test
                                                                                        PROPERTIES RUN_SERIAL
                                                                                            ON)
                                                                                    tact_test(
                                                                                        unit /
                                                                                        gui_shapes_test.cpp
                                                                                            USES gui_docking gui_surface
                                                                                                gui_render prep_surface
                                                                                                    prep_synthetic
                                                                                                        scene
                                                                                                            base)
                                                                                        tact_test(
                                                                                            unit /
                                                                                            gui_contour_test
                                                                                                .cpp USES gui_window gui_docking
                                                                                                    gui_render prep_mesh
                                                                                                        topics shm scene
                                                                                                            base SYSTEM
                                                                                                                CLI11::CLI11
                                                                                                                    TIMEOUT 300)
                                                                                            target_compile_definitions(
                                                                                                gui_contour_test PRIVATE
                                                                                                    TACT_PREP =
                                                                                                        "$<"
                                                                                                        "TARG"
                                                                                                        "ET_"
                                                                                                        "FILE"
                                                                                                        ":tac"
                                                                                                        "t-"
                                                                                                        "prep"
                                                                                                        ">")
                                                                                                add_dependencies(
                                                                                                    gui_contour_test
                                                                                                        tact -
                                                                                                    prep)
                                                                                                    tact_test(
                                                                                                        unit /
                                                                                                        gui_drill_controller_test
                                                                                                            .cpp USES gui_window gui_drilling gui_drilling_site
                                                                                                                gui_link gui_dashboard gui_render
                                                                                                                    prep_mesh topics shm
                                                                                                                        scene base SYSTEM
                                                                                                                            nlohmann_json::nlohmann_json
                                                                                                                                CLI11::
                                                                                                                                    CLI11)
                                                                                                        tact_test(
                                                                                                            unit /
                                                                                                            gui_draw_test
                                                                                                                .cpp USES gui_window gui_docking
                                                                                                                    gui_dashboard gui_stereo gui_render
                                                                                                                        launch prep_mesh
                                                                                                                            topics shm
                                                                                                                                scene base
                                                                                                                                    TIMEOUT 300)
                                                                                                            endif()
