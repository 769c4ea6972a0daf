tact_fuzz(ipc_fuzz SOURCES fuzz/ipc_fuzz.cpp USES base shm)
# Only the source file, so that it is fuzzed in builds without a window.
tact_fuzz(bone_region_fuzz SOURCES fuzz/bone_region_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/drilling/bone_follower.cpp
    USES base shm topics scene)
tact_fuzz(spacenav_fuzz SOURCES fuzz/spacenav_fuzz.cpp USES base spacenav)
