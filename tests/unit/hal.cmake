# Tests of hal's drivers.
tact_test(unit/hal_tracker_dbc_test.cpp USES base tracker)
tact_test(unit/hal_tracker_filter_test.cpp USES base tracker)
tact_test(unit/hal_tracker_frames_test.cpp USES base tracker SYSTEM rapidcheck)
tact_test(unit/hal_tracker_registration_test.cpp USES base tracker SYSTEM rapidcheck)
