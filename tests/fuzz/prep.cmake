# Fuzz targets of prep.
tact_fuzz(map_fuzz SOURCES fuzz/map_fuzz.cpp USES prep_map)
tact_fuzz(structure_fuzz SOURCES fuzz/structure_fuzz.cpp USES prep_structure)
tact_fuzz(export_fuzz SOURCES fuzz/export_fuzz.cpp USES prep_export)
tact_fuzz(mesh_fuzz SOURCES fuzz/mesh_fuzz.cpp USES prep_mesh prep_mesh_file)
tact_fuzz(scan_fuzz SOURCES fuzz/scan_fuzz.cpp USES prep_drilling prep_volume)
tact_fuzz(structure_table_fuzz SOURCES fuzz/structure_table_fuzz.cpp USES prep_drilling prep_volume)
tact_fuzz(field_fuzz SOURCES fuzz/field_fuzz.cpp USES base scene prep_field)
