# Benchmarks of ipc/scene.
tact_bench(bench/fit_bench.cpp USES base scene)
