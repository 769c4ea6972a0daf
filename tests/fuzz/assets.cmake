# Fuzz targets of assets.
tact_fuzz(scene_fuzz SOURCES fuzz/scene_fuzz.cpp USES assets force prep_mesh prep_surface)
