# Benchmarks of force.
tact_bench(bench/docking_bench.cpp USES scene force)
tact_bench(bench/clash_bench.cpp USES scene force)
tact_bench(bench/refine_bench.cpp USES scene force prep_surface prep_synthetic)
tact_bench(bench/touch_modes_bench.cpp USES force prep_surface prep_synthetic)
tact_bench(bench/drilling_bench.cpp USES force)
tact_bench(bench/drill_levels_bench.cpp USES force)
