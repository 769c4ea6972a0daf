# Tests of hal's drivers.
tact_test(unit/hal_emu_cp2112_test.cpp USES emu_lines)
tact_test(unit/hal_line_logic_test.cpp USES base io)
tact_test(unit/hal_lines_contract_test.cpp USES base io hal LABELS tsan)
tact_test(unit/hal_socket_can_test.cpp USES base tracker hal LABELS tsan)
tact_test(unit/hal_tracker_contract_test.cpp USES base tracker hal LABELS tsan)
tact_test(unit/hal_tracker_dbc_test.cpp USES base tracker)
tact_test(unit/hal_tracker_filter_test.cpp USES base tracker)
tact_test(unit/hal_tracker_frames_test.cpp USES base tracker SYSTEM rapidcheck)
tact_test(unit/hal_tracker_reader_test.cpp USES base tracker)
tact_test(unit/hal_tracker_registration_test.cpp USES base tracker SYSTEM rapidcheck)
tact_test(unit/hal_emu_board_test.cpp USES base arm phantom emu_board)
tact_test(unit/hal_emu_script_test.cpp USES base arm tracker emu_script)
# Parts and faults are read without a kernel that has them; wrong usage and what cannot start have codes of their own.
add_test(NAME hal_emu_usage COMMAND sh -c "emu=$<TARGET_FILE:tact-emu>; $emu --arm A --arm B --tracker can0:fd:240:4 --check || exit 1
    $emu --nonsense 2>&1; test $? = 2 || exit 1; $emu --arm A --arm A; test $? = 1 || exit 1; $emu; test $? = 1")
tact_test(unit/hal_phantom_usb_test.cpp USES base arm phantom phantom_usb hal_api emu_board)
tact_test(unit/hal_phantom_thread_test.cpp USES base arm phantom phantom_usb hal_api emu_board LABELS tsan)
# A stand-in for the vendor's library, loaded as that is; and one that lacks functions.
tact_plugin(fake_hd SOURCES support/fake_hd_library.cpp USES openhaptics)
tact_plugin(fake_hd_old SOURCES support/fake_hd_old.cpp)
tact_test(unit/hal_openhaptics_test.cpp USES base openhaptics hal_api LABELS tsan)
add_dependencies(hal_openhaptics_test fake_hd fake_hd_old)
target_compile_definitions(hal_openhaptics_test PRIVATE TACT_FAKE_HD="$<TARGET_FILE:fake_hd>"
    TACT_FAKE_HD_OLD="$<TARGET_FILE:fake_hd_old>")
tact_test(unit/hal_polhem_test.cpp USES base arm phantom phantom_usb polhem probe hal_api emu_board SYSTEM rapidcheck)
tact_test(unit/hal_falcon_kinematics_test.cpp USES base falcon_core)
tact_test(unit/hal_falcon_packets_test.cpp USES base falcon_core SYSTEM rapidcheck)
