# Benches of rt.
tact_bench(bench/supervisor_bench.cpp USES base shm topics hal io force servo threads config start)
if(TEST supervisor_bench)
    # It hogs a processor at real-time priority: beside it, others would starve.
    set_tests_properties(supervisor_bench PROPERTIES RUN_SERIAL ON)
endif()
