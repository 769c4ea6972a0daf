# For `run`: seconds of a loop, and of a sleep of 0.1 s, by the machine's clock.
exec python3 - <<'END'
import time

begun = time.monotonic()
for _ in range(300000):
    pass
counted = time.monotonic()
time.sleep(0.1)
print(counted - begun, time.monotonic() - counted)
END
