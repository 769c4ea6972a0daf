tact_bench(bench/ipc_bench.cpp USES base shm topics)
