# Fuzz targets of prep.
tact_fuzz(map_fuzz SOURCES fuzz/map_fuzz.cpp USES prep_map)
# clang 14 with the standard library of g++ 12 does not compile gemmi's reader of CIF files as C++20; there the
# replay, under g++ and its sanitizers, is what runs.
tact_fuzz(structure_fuzz SOURCES fuzz/structure_fuzz.cpp USES prep_structure CLANG_FROM 15)
tact_fuzz(export_fuzz SOURCES fuzz/export_fuzz.cpp USES prep_export CLANG_FROM 15)
tact_fuzz(mesh_fuzz SOURCES fuzz/mesh_fuzz.cpp USES prep_mesh prep_mesh_file)
tact_fuzz(scan_fuzz SOURCES fuzz/scan_fuzz.cpp USES prep_volume)
