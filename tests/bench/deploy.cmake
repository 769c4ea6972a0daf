# Benchmarks of deploy.
