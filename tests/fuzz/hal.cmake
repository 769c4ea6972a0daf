# Fuzz targets of hal.
tact_fuzz(tracker_fuzz SOURCES fuzz/tracker_fuzz.cpp USES base tracker)
tact_fuzz(phantom_fuzz SOURCES fuzz/phantom_fuzz.cpp USES phantom)
tact_fuzz(emu_script_fuzz SOURCES fuzz/emu_script_fuzz.cpp USES base emu_script)
tact_fuzz(phantom_usb_fuzz SOURCES fuzz/phantom_usb_fuzz.cpp USES base arm phantom phantom_usb hal_api)
tact_fuzz(polhem_fuzz SOURCES fuzz/polhem_fuzz.cpp USES base phantom phantom_usb polhem)
tact_fuzz(falcon_fuzz SOURCES fuzz/falcon_fuzz.cpp USES base arm phantom phantom_usb falcon falcon_core hal_api)
tact_fuzz(haply_fuzz SOURCES fuzz/haply_fuzz.cpp USES base haply SYSTEM nlohmann_json::nlohmann_json)
