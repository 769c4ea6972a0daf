# Benchmarks of prep.
tact_bench(bench/simplify_bench.cpp USES base scene prep_mesh prep_synthetic)
