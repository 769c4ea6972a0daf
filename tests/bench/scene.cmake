# Benches of assets.
tact_bench(bench/fit_bench.cpp USES base scene)
