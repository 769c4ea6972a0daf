# Benches of rt.
