# Tests of deploy.
tact_tests(launch_tests SOURCES
        unit/deploy_child_test.cpp unit/deploy_servo_core_test.cpp unit/deploy_doctor_test.cpp
        unit/deploy_probe_test.cpp unit/deploy_probe_arms_test.cpp unit/deploy_x_server_test.cpp unit/deploy_eval_test.cpp
    USES launch base probe force bench_docking SYSTEM nlohmann_json::nlohmann_json)
tact_tests(station_tests SOURCES
        unit/deploy_station_test.cpp unit/deploy_station_verify_test.cpp unit/deploy_metrics_test.cpp
        unit/deploy_monitoring_test.cpp
    USES base launch_station topics station station_metrics version shm launch SYSTEM nlohmann_json::nlohmann_json
        PkgConfig::HTTPLIB)
tact_test(unit/deploy_igtl_test.cpp USES launch igtl base shm topics scene)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
add_test(NAME reproduce_draw_test COMMAND /usr/bin/python3 tests/reproduce/draw.py --self-test WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(reproduce_draw_test PROPERTIES TIMEOUT 120 SKIP_RETURN_CODE 77)
tact_tests(drill_command_tests SOURCES
        unit/deploy_drill_test.cpp unit/deploy_drilling_test.cpp unit/reproduce_test.cpp
    USES bench reproduce launch scene base shm topics SYSTEM nlohmann_json::nlohmann_json)
tact_test(unit/deploy_info_test.cpp USES launch force scene reference SYSTEM nlohmann_json::nlohmann_json)
tact_test(unit/deploy_run_test.cpp USES launch shm topics scene base)
tact_test(unit/deploy_run_save_test.cpp USES launch shm topics scene base)
tact_test(unit/deploy_scene_switch_test.cpp USES launch shm topics scene scene_session base)
add_test(NAME deploy_run_script_test COMMAND tests/unit/deploy_run_script_test.sh WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
if(TACT_GUI AND NOT TACT_SANITIZE)
    add_test(NAME deploy_install_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_install_test.sh ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})
endif()
if(TACT_GUI)
    add_test(NAME deploy_version_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_version_test.py ${CMAKE_SOURCE_DIR}
        ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_VERSION})
endif()
add_test(NAME deploy_shell_test COMMAND tests/unit/deploy_shell_test.sh WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
if(TARGET manual)
    find_package(Python3 COMPONENTS Interpreter REQUIRED)
    add_test(NAME deploy_manual_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_manual_test.py $<TARGET_FILE_DIR:tact>)
endif()
if(TACT_GUI)
    add_test(NAME deploy_e2e_test COMMAND tests/unit/deploy_e2e_test.sh $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(deploy_e2e_test PROPERTIES LABELS e2e TIMEOUT 600 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
    add_test(NAME deploy_drill_e2e_test COMMAND tests/unit/deploy_drill_e2e_test.sh $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(deploy_drill_e2e_test PROPERTIES LABELS e2e TIMEOUT 900 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
    add_test(NAME deploy_replay_e2e_test COMMAND tests/unit/deploy_replay_e2e_test.sh $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(deploy_replay_e2e_test PROPERTIES LABELS e2e TIMEOUT 900 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
    if(NOT TACT_SANITIZE)
        add_test(NAME operate_test COMMAND tests/e2e/operate_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME mouse_hand_test COMMAND tests/e2e/mouse_hand_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME space_mouse_test COMMAND tests/e2e/space_mouse_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME labels_test COMMAND tests/e2e/labels_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME window_states_test COMMAND tests/e2e/window_states_test.py $<TARGET_FILE_DIR:tact>
            ${CMAKE_BINARY_DIR}/window_states 1280x720 WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME figures_test COMMAND tests/e2e/figures_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME start_page_test COMMAND tests/e2e/start_page_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME add_structure_test COMMAND tests/e2e/add_structure_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME session_test COMMAND tests/e2e/session_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME look_back_test COMMAND tests/e2e/look_back_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        add_test(NAME visual_knobs_test COMMAND tests/e2e/visual_knobs_test.py $<TARGET_FILE_DIR:tact> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
        set_tests_properties(visual_knobs_test operate_test mouse_hand_test space_mouse_test labels_test window_states_test figures_test start_page_test session_test look_back_test add_structure_test
            PROPERTIES LABELS e2e TIMEOUT 900 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
    endif()
endif()
find_package(Python3 COMPONENTS Interpreter REQUIRED)
add_test(NAME deploy_rights_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_rights_test.py ${CMAKE_SOURCE_DIR})
add_test(NAME deploy_dock_cache_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_dock_cache_test.py $<TARGET_FILE_DIR:tact>)
add_test(NAME deploy_add_structure_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_add_structure_test.py $<TARGET_FILE_DIR:tact>)
set_tests_properties(deploy_add_structure_test PROPERTIES TIMEOUT 300)
add_test(NAME bench_governor_scenes_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/bench_governor_scenes_test.py $<TARGET_FILE_DIR:tact>)
set_tests_properties(bench_governor_scenes_test PROPERTIES TIMEOUT 300)
add_test(NAME certify_cli_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/certify_cli_test.py $<TARGET_FILE_DIR:tact>)
add_test(NAME config_check_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/config_check_test.py $<TARGET_FILE_DIR:tact>
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
add_test(NAME shared_core_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/shared_core_test.py $<TARGET_FILE_DIR:tact>
    $<TARGET_FILE:write_small_scene>)
set_tests_properties(shared_core_test PROPERTIES TIMEOUT 300 SKIP_RETURN_CODE 77)
add_test(NAME monitoring_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/e2e/monitoring_test.py $<TARGET_FILE_DIR:tact>
    $<TARGET_FILE:write_small_scene> WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
set_tests_properties(monitoring_test PROPERTIES LABELS e2e TIMEOUT 120 SKIP_RETURN_CODE 77)
if(NOT TACT_SANITIZE)  # not with sanitizers, which slow the servo; deploy_igtl_test, hal_igtl_* and igtl_fuzz cover the code
    set(igtl_test Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/e2e/igtl_test.py $<TARGET_FILE_DIR:tact>
        $<TARGET_FILE:write_small_scene> ${TACT_IGTL_EXAMPLES})
    add_test(NAME igtl_test COMMAND ${igtl_test} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(igtl_test PROPERTIES LABELS e2e TIMEOUT 600 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
    add_test(NAME igtl_minute_test COMMAND ${igtl_test} --seconds 60 Server.test_no_message_is_lost_at_the_stated_rate
        WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(igtl_minute_test PROPERTIES LABELS "e2e;long" TIMEOUT 300)
    # Only by ctest -C nightly -L nightly.
    add_test(NAME igtl_ten_minutes_test CONFIGURATIONS nightly COMMAND ${igtl_test} --seconds 600
        Server.test_debians_client_loses_no_pose_and_hostile_clients_do_not_delay_the_servo WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(igtl_ten_minutes_test PROPERTIES LABELS "e2e;long;nightly" TIMEOUT 900 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)
endif()
# h5py comes from the system's packages and is available only in the system's Python.
find_program(TACT_SYSTEM_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(TACT_SYSTEM_PYTHON3)
    add_test(NAME record_kill_test COMMAND ${TACT_SYSTEM_PYTHON3} ${CMAKE_CURRENT_SOURCE_DIR}/unit/record_kill_test.py
        $<TARGET_FILE_DIR:tact-record> $<TARGET_FILE:write_small_scene>)
    set_tests_properties(record_kill_test PROPERTIES TIMEOUT 600 SKIP_RETURN_CODE 77)
    if(TACT_GUI AND NOT TACT_SANITIZE)  # not with sanitizers, whose allocators keep freed memory
        add_test(NAME soak_test COMMAND ${TACT_SYSTEM_PYTHON3} ${CMAKE_CURRENT_SOURCE_DIR}/e2e/soak_test.py
            $<TARGET_FILE_DIR:tact> synthetic --seconds 20 --rate 2000)
        set_tests_properties(soak_test PROPERTIES LABELS e2e TIMEOUT 300 SKIP_RETURN_CODE 77 RUN_SERIAL ON)
    endif()
endif()
add_test(NAME replay_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/replay_test.py $<TARGET_FILE_DIR:tact>)
set_tests_properties(replay_test PROPERTIES TIMEOUT 900)
add_test(NAME drilled_bone_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/drilled_bone_test.py $<TARGET_FILE_DIR:tact>)
set_tests_properties(drilled_bone_test PROPERTIES TIMEOUT 900)
if(NOT TACT_SANITIZE)  # not with sanitizers, whose runtimes make system calls of their own and refuse strace
    add_test(NAME deploy_units_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_units_test.py ${CMAKE_SOURCE_DIR}
        $<TARGET_FILE_DIR:tact> $<TARGET_FILE:write_small_scene>)
    set_tests_properties(deploy_units_test PROPERTIES TIMEOUT 600)
endif()
add_test(NAME deploy_station_e2e_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/deploy_station_e2e_test.py
    ${CMAKE_SOURCE_DIR} $<TARGET_FILE_DIR:tact> $<TARGET_FILE:write_small_scene>)
set_tests_properties(deploy_station_e2e_test PROPERTIES TIMEOUT 600 RUN_SERIAL TRUE)
set_tests_properties(deploy_eval_test PROPERTIES LABELS long)  # not under sanitizers
add_test(NAME test_files_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/unit/test_files_test.py
    ${CMAKE_BINARY_DIR}/tests ${CMAKE_SOURCE_DIR})
