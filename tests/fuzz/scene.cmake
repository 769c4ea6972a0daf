# Fuzz targets of ipc/scene.
tact_fuzz(scene_fuzz SOURCES fuzz/scene_fuzz.cpp USES scene force prep_mesh prep_surface)
tact_fuzz(bone_file_fuzz SOURCES fuzz/bone_file_fuzz.cpp USES start force scene base)
tact_fuzz(peek_fuzz SOURCES fuzz/peek_fuzz.cpp USES scene base)
tact_fuzz(bake_record_fuzz SOURCES fuzz/bake_record_fuzz.cpp USES scene base)
tact_fuzz(session_fuzz SOURCES fuzz/session_fuzz.cpp USES scene_session base)
tact_fuzz(scene_switch_fuzz SOURCES fuzz/scene_switch_fuzz.cpp USES scene base)
