# Benches of force.
tact_bench(bench/docking_bench.cpp USES assets force)
