# Benches of assets.
