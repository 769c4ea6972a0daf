# Fuzz targets of hal.
tact_fuzz(tracker_fuzz SOURCES fuzz/tracker_fuzz.cpp USES base tracker)
