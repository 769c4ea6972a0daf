# Tests of hal's drivers.
tact_test(unit/hal_socket_can_test.cpp USES base tracker hal LABELS tsan)
tact_test(unit/hal_tracker_contract_test.cpp USES base tracker hal LABELS tsan)
tact_test(unit/hal_tracker_dbc_test.cpp USES base tracker)
tact_test(unit/hal_tracker_filter_test.cpp USES base tracker)
tact_test(unit/hal_tracker_frames_test.cpp USES base tracker SYSTEM rapidcheck)
tact_test(unit/hal_tracker_reader_test.cpp USES base tracker)
tact_test(unit/hal_tracker_registration_test.cpp USES base tracker SYSTEM rapidcheck)
tact_test(unit/hal_emu_board_test.cpp USES base arm phantom emu_board)
