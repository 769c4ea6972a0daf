# Two processes at full speed for two seconds. unit/ipc_latest_ring_test.cpp does the same in one process, for the thread
# sanitizer.
tact_program(two_process_stress SOURCES stress/two_process_stress.cpp USES shm)
set_target_properties(two_process_stress PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_test(NAME two_process_stress COMMAND two_process_stress 2)
set_tests_properties(two_process_stress PROPERTIES TIMEOUT 300 LABELS stress)
