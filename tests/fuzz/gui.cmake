# Fuzz targets of gui: only the sources of its parsers, so that they are fuzzed in builds without a window.
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
# The installed toml++ library: with its headers alone the undefined-behaviour sanitizer stops at white space beyond Latin-1.
tact_fuzz(window_state_fuzz SOURCES fuzz/window_state_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/window/window_state.cpp
        ${CMAKE_SOURCE_DIR}/gui/base/toml_keys.cpp
    USES base SYSTEM tomlplusplus::tomlplusplus)
tact_fuzz(recents_fuzz SOURCES fuzz/recents_fuzz.cpp ${CMAKE_SOURCE_DIR}/ipc/scene/session/recent_scenes.cpp
    USES base SYSTEM nlohmann_json::nlohmann_json)
tact_fuzz(import_answers_fuzz SOURCES fuzz/import_answers_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/window/import_answers.cpp
        ${CMAKE_SOURCE_DIR}/gui/window/import_form.cpp
    USES base scene_bone SYSTEM nlohmann_json::nlohmann_json)
tact_fuzz(stage_fuzz SOURCES fuzz/stage_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/stereo/stage_file.cpp
        ${CMAKE_SOURCE_DIR}/gui/stereo/stage_file_write.cpp ${CMAKE_SOURCE_DIR}/gui/base/toml_keys.cpp
        ${CMAKE_SOURCE_DIR}/gui/render/screen.cpp ${CMAKE_SOURCE_DIR}/gui/render/camera.cpp
    USES base SYSTEM tomlplusplus::tomlplusplus)
tact_fuzz(found_places_fuzz SOURCES fuzz/found_places_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/docking/found_places.cpp
    USES base SYSTEM nlohmann_json::nlohmann_json)
tact_fuzz(training_task_fuzz SOURCES fuzz/training_task_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/drilling/training/training_plan.cpp
        ${CMAKE_SOURCE_DIR}/gui/base/toml_keys.cpp
    USES base SYSTEM tomlplusplus::tomlplusplus)
tact_fuzz(import_form_fuzz SOURCES fuzz/import_form_fuzz.cpp ${CMAKE_SOURCE_DIR}/gui/window/import_form.cpp
    USES base scene_bone SYSTEM nlohmann_json::nlohmann_json)
