# Benches of rt.
tact_bench(bench/supervisor_bench.cpp USES base shm topics hal io force loop)
