# Tests of hal's drivers.
tact_tests(emu_tests SOURCES
        unit/emu_cp2112_test.cpp unit/emu_board_test.cpp unit/emu_script_test.cpp unit/hal_line_logic_test.cpp
    USES emu_lines base arm phantom emu_board tracker emu_script io)
tact_test(unit/hal_lines_contract_test.cpp USES base io hal LABELS tsan)
tact_tests(hal_shared_tests SOURCES
        unit/hal_socket_can_test.cpp unit/hal_phantom_thread_test.cpp
    USES base tracker hal arm phantom phantom_usb hal_api emu_board LABELS tsan)
tact_test(unit/hal_tracker_contract_test.cpp USES base tracker hal LABELS tsan)
tact_test(unit/hal_igtl_contract_test.cpp USES base igtl tracker hal LABELS tsan)
tact_tests(hal_tracker_tests SOURCES
        unit/hal_igtl_reader_test.cpp        unit/hal_sim_hold_test.cpp unit/hal_tracker_dbc_test.cpp unit/hal_tracker_filter_test.cpp
        unit/hal_tracker_frames_test.cpp unit/hal_tracker_reader_test.cpp
    USES base igtl tracker hal SYSTEM rapidcheck)
# Parts and faults are read without kernel interfaces; wrong usage and failed starts have different exit codes.
add_test(NAME hal_emu_usage COMMAND sh -c "emu='$<TARGET_FILE:tact-emu>'; \"$emu\" --arm A --arm B --tracker can0:fd:240:4 --check || exit 1
    \"$emu\" --nonsense 2>&1; test $? = 2 || exit 1; \"$emu\" --arm A --arm A; test $? = 1 || exit 1; \"$emu\"; test $? = 1")
tact_test(unit/hal_phantom_usb_test.cpp USES base arm phantom phantom_usb hal_api emu_board)
# A substitute for the vendor's library, loaded in its place, and one that lacks functions.
tact_plugin(fake_hd SOURCES support/fake_hd_library.cpp USES openhaptics)
tact_plugin(fake_hd_old SOURCES support/fake_hd_old.cpp)
tact_test(unit/hal_openhaptics_test.cpp USES base openhaptics hal_api LABELS tsan)
add_dependencies(hal_openhaptics_test fake_hd fake_hd_old)
target_compile_definitions(hal_openhaptics_test PRIVATE TACT_FAKE_HD="$<TARGET_FILE:fake_hd>"
    TACT_FAKE_HD_OLD="$<TARGET_FILE:fake_hd_old>")
tact_plugin(fake_fd SOURCES support/fake_fd_library.cpp USES forcedimension)
tact_plugin(fake_fd_dhd SOURCES support/fake_fd_library.cpp USES forcedimension)  # libdhd alone, without libdrd
target_compile_definitions(fake_fd_dhd PRIVATE TACT_FAKE_FD_WITHOUT_DRD)
tact_plugin(fake_fd_old SOURCES support/fake_fd_old.cpp)
tact_test(unit/hal_forcedimension_test.cpp USES base forcedimension hal_api LABELS tsan)
tact_test(unit/hal_forcedimension_faults_test.cpp USES base forcedimension hal_api)
tact_test(unit/hal_forcedimension_open_test.cpp USES base forcedimension hal_api)
foreach(test hal_forcedimension_test hal_forcedimension_faults_test hal_forcedimension_open_test)
    add_dependencies(${test} fake_fd fake_fd_dhd fake_fd_old)
    target_compile_definitions(${test} PRIVATE TACT_FAKE_FD="$<TARGET_FILE:fake_fd>"
        TACT_FAKE_FD_DHD="$<TARGET_FILE:fake_fd_dhd>" TACT_FAKE_FD_OLD="$<TARGET_FILE:fake_fd_old>")
endforeach()
tact_test(unit/hal_haply_test.cpp USES base haply hal_api SYSTEM nlohmann_json::nlohmann_json)
tact_test(unit/hal_haply_link_test.cpp USES base haply hal_api SYSTEM nlohmann_json::nlohmann_json LABELS tsan)
tact_test(unit/hal_polhem_test.cpp USES base arm phantom phantom_usb polhem probe hal_api emu_board SYSTEM rapidcheck)
tact_tests(hal_boards_tests SOURCES
        unit/hal_phantom_packets_test.cpp unit/hal_falcon_boot_test.cpp unit/hal_falcon_kinematics_test.cpp
        unit/hal_falcon_packets_test.cpp
    USES phantom base falcon falcon_core phantom_usb arm hal_api SYSTEM rapidcheck)
tact_test(unit/hal_falcon_test.cpp USES base falcon falcon_core phantom phantom_usb arm hal_api LABELS tsan)
