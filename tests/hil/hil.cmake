# Programs that run only in the virtual machine of tests/hil.
tact_program(hil_lines_story SOURCES hil/lines_story.cpp scenario/rig.cpp USES base shm topics scene launch emu_lines)
target_compile_definitions(hil_lines_story PRIVATE TACT_RT_PROGRAM="$<TARGET_FILE:tact-rt>")
add_dependencies(hil_lines_story tact-rt)
tact_program(hil_pause_loop SOURCES hil/pause_loop.cpp USES base)
set_target_properties(hil_lines_story hil_pause_loop PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
if(TACT_GUI)
    tact_program(hil_input_story SOURCES hil/input_story.cpp USES gui_input gui_dashboard spacenav base)
    set_target_properties(hil_input_story PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
endif()
