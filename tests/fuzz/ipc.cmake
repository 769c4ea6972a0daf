tact_fuzz(ipc_fuzz SOURCES fuzz/ipc_fuzz.cpp USES base shm)
