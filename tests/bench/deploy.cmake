# Benches of deploy.
