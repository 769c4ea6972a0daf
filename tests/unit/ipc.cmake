# Tests of ipc/base, ipc/shm and ipc/topics.
tact_tests(base_tests SOURCES
        unit/base_histogram_test.cpp unit/base_error_test.cpp unit/base_whole_numbers_test.cpp unit/ipc_text_test.cpp
        unit/ipc_manual_test.cpp unit/ipc_png_test.cpp unit/base_random_test.cpp unit/base_servo_clock_test.cpp
    USES base topics manual image)
tact_test(unit/ipc_igtl_test.cpp USES base igtl)
tact_test(unit/ipc_latest_ring_test.cpp USES base shm SYSTEM rapidcheck LABELS tsan)
tact_tests(ipc_tests SOURCES
        unit/ipc_region_test.cpp unit/ipc_servo_threads_test.cpp unit/ipc_link_test.cpp unit/ipc_bone_region_test.cpp
        unit/ipc_death_test.cpp unit/ipc_frames_test.cpp
    USES base shm topics)
tact_tests(ipc_record_tests SOURCES
        unit/ipc_record_test.cpp unit/bench_ipc_test.cpp
    USES base shm topics record bench_ipc)
