# Tests of ipc/base, ipc/shm and ipc/topics.
tact_test(unit/base_histogram_test.cpp USES base)
tact_test(unit/base_error_test.cpp USES base)
tact_test(unit/ipc_latest_ring_test.cpp USES base shm SYSTEM rapidcheck LABELS tsan)
tact_test(unit/ipc_region_test.cpp USES base shm topics)
tact_test(unit/ipc_link_test.cpp USES base shm topics)
tact_test(unit/ipc_death_test.cpp USES base shm topics)
tact_test(unit/ipc_text_test.cpp USES topics)
tact_test(unit/deploy_bench_ipc_test.cpp USES bench_ipc)
