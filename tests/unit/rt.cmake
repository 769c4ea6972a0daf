# Tests of rt/safety, rt/govern, rt/servo, rt/threads, rt/config and hal.
find_package(rapidcheck REQUIRED)
find_package(spdlog REQUIRED)

tact_tests(safety_tests SOURCES
        unit/safety_state_machine_test.cpp unit/safety_output_chain_test.cpp unit/safety_smooth_gain_test.cpp
        unit/safety_watchdogs_test.cpp
    USES base safety SYSTEM rapidcheck)
tact_tests(govern_tests SOURCES
        unit/govern_governor_test.cpp unit/govern_display_test.cpp unit/govern_level_fit_test.cpp
        unit/govern_level_free_test.cpp unit/govern_level_rows_test.cpp unit/govern_level_slow_test.cpp
        unit/govern_level_first_test.cpp
        unit/govern_rate_hold_test.cpp unit/govern_replay_test.cpp
    USES base govern SYSTEM rapidcheck)
tact_test(unit/replay_marks_test.cpp USES base topics replay)
tact_test(unit/replay_scene_test.cpp USES base scene scene_session record replay)
tact_test(unit/hal_sim_test.cpp USES base hal)
tact_test(unit/hal_mouse_hand_test.cpp USES base shm hal)
tact_tests(arm_tests SOURCES
        unit/base_pacer_test.cpp unit/base_motor_heat_test.cpp unit/hal_arm_kinematics_test.cpp
        unit/hal_arm_drive_test.cpp unit/hal_arm_velocity_test.cpp unit/hal_arm_calibration_test.cpp
        unit/hal_arm_table_test.cpp
    USES base arm SYSTEM rapidcheck)
tact_tests(config_tests SOURCES
        unit/config_test.cpp unit/config_arm_test.cpp unit/config_hands_test.cpp unit/config_problems_test.cpp
    USES base hal servo threads config govern arm start)
tact_tests(threads_shared_tests SOURCES
        unit/threads_head_feed_test.cpp unit/threads_supervisor_test.cpp unit/servo_orders_test.cpp
    USES base hal topics servo threads config shm LABELS tsan)
tact_tests(threads_tests SOURCES
        unit/threads_housekeeping_test.cpp unit/threads_command_feed_test.cpp unit/threads_mouse_feed_test.cpp unit/threads_log_sink_test.cpp
        unit/threads_service_notify_test.cpp
    USES base topics servo threads config SYSTEM spdlog::spdlog)
tact_tests(start_tests SOURCES
        unit/start_scene_bone_test.cpp unit/start_bodies_test.cpp unit/start_systems_test.cpp unit/start_drill_test.cpp
        unit/start_resume_bone_test.cpp
    USES base shm topics scene force start hal servo threads config prep_surface prep_synthetic)

# The stages of a cycle, without a Servo.
tact_tests(servo_tests SOURCES
        unit/servo_input_stages_test.cpp unit/servo_force_stages_test.cpp unit/servo_armed_metrics_test.cpp
        unit/servo_output_stages_test.cpp unit/bench_servo_test.cpp unit/bench_governor_test.cpp
    USES base topics hal_api force servo bench_servo bench SYSTEM nlohmann_json::nlohmann_json)


# The whole loop in lockstep.
tact_tests(cycle_scenario_tests SOURCES
        scenario/servo_scenario_test.cpp scenario/drill_scenario_test.cpp scenario/stiffness_scenario_test.cpp
        scenario/record_scenario_test.cpp
    USES base topics hal force servo threads config start safety recorder)
tact_test(scenario/docking_arm_scenario_test.cpp USES base topics scene hal force servo threads config start reference)
tact_test(scenario/supervisor_scenario_test.cpp USES base topics hal io force servo threads config start LABELS tsan)
tact_tests(system_scenario_tests SOURCES
        scenario/servo_faults_scenario_test.cpp scenario/lines_scenario_test.cpp scenario/bodies_scenario_test.cpp
        scenario/governor_scenario_test.cpp
    USES base topics hal force servo threads config start scene govern)

# The servo path uses neither heap nor mutex: the test includes the interposers of tact-rt.
tact_program(rt_safe_test SOURCES rt_safe/rt_safe_test.cpp rt_safe/vendor_rt_safe_test.cpp ${CMAKE_SOURCE_DIR}/rt/servo/interpose.cpp
    USES base topics scene arm phantom phantom_usb forcedimension hal emu_board force servo threads config start SYSTEM GTest::gtest GTest::gtest_main)
add_dependencies(rt_safe_test fake_fd)
target_compile_definitions(rt_safe_test PRIVATE TACT_FAKE_FD="$<TARGET_FILE:fake_fd>")
set_target_properties(rt_safe_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME rt_safe_test COMMAND rt_safe_test WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(rt_safe_test PROPERTIES TIMEOUT 300)

# Every driver loses its device at random instants, under the same interposers.
tact_program(unplug_rt_safe_test SOURCES rt_safe/unplug_rt_safe_test.cpp ${CMAKE_SOURCE_DIR}/rt/servo/interpose.cpp
    USES base topics arm phantom phantom_usb polhem openhaptics forcedimension haply falcon falcon_core hal emu_board force servo threads config start
    SYSTEM nlohmann_json::nlohmann_json GTest::gtest GTest::gtest_main)
add_dependencies(unplug_rt_safe_test fake_fd fake_hd)
target_compile_definitions(unplug_rt_safe_test PRIVATE TACT_FAKE_FD="$<TARGET_FILE:fake_fd>" TACT_FAKE_HD="$<TARGET_FILE:fake_hd>")
set_target_properties(unplug_rt_safe_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME unplug_rt_safe_test COMMAND unplug_rt_safe_test WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(unplug_rt_safe_test PROPERTIES TIMEOUT 300)

# The process: signals, refusals, system calls of the servo thread.
tact_program(write_small_scene SOURCES support/write_small_scene.cpp USES base scene)
set_target_properties(write_small_scene PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
tact_program(stand_in_person SOURCES support/stand_in_person.cpp USES base shm topics)
set_target_properties(stand_in_person PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
find_package(Python3 COMPONENTS Interpreter REQUIRED)
add_test(NAME rt_process_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/rt_safe/process_test.py
    ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} $<TARGET_FILE:write_small_scene>)
set_tests_properties(rt_process_test PROPERTIES TIMEOUT 600)
