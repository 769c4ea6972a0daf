tact_fuzz(ipc_fuzz SOURCES fuzz/ipc_fuzz.cpp USES base shm)
# The file alone, so that it is fuzzed where no window is built.
tact_fuzz(bone_region_fuzz SOURCES fuzz/bone_region_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/drilling/bone_follower.cpp
    USES base shm topics scene)
