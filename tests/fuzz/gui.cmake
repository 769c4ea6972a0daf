# Fuzz targets of gui: replayed wherever the window is built; the preset that looks for more leaves the window out.
if(TACT_GUI)
    tact_fuzz(desk_fuzz SOURCES fuzz/desk_fuzz.cpp USES base gui_panels gui_desk)
    tact_fuzz(stage_fuzz SOURCES fuzz/stage_fuzz.cpp USES base gui_render gui_stage)
endif()
