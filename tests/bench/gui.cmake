# Benches of gui.
