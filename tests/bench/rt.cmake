# Benchmarks of rt.
tact_bench(bench/supervisor_bench.cpp USES base shm topics hal io force servo threads config start)
if(TEST supervisor_bench)
    # It occupies a processor at real-time priority: tests in parallel would starve.
    set_tests_properties(supervisor_bench PROPERTIES RUN_SERIAL ON)
endif()
