// Interprets files that the user drops onto the window or marks in a list: a scene to open, or raw data that `tact`
// bakes into one.
//
// Only by their endings (ipc/scene/file/scene_kinds); tact-prep checks the contents.  Fails by a message.  Thread
// any.
#pragma once

#include <string>
#include <vector>

#include "ipc/scene/file/scene_kinds.hpp"

namespace tact {

inline constexpr std::size_t kDroppedMost = 17;  // a map and as many structures as a scene holds

// The files that can be dropped, as a sentence.
[[nodiscard]] const std::string& dropped_kinds_text();

// The type of a raw file ("map", "mesh", ...) by its ending; empty if no system reads it. No disk access.
[[nodiscard]] const char* raw_file_text(const std::string& name);
// The type of a folder that stands for one file: of DICOM files or images.
[[nodiscard]] const char* raw_folder_text();

struct Dropped {
    std::string scene;                // to open
    std::vector<std::string> import;  // arguments of `tact`: {"dock", MAP, MODEL...}, {"touch", MESH}, ...
    std::vector<std::string>
        add;  // arguments that add the files to the scene that is shown: {"dock", SCENE, MODEL...}
    std::string trouble;  // what is impossible, why, and the fix
};

// The scene that is shown, to which files of some types can be added.
struct ShownScene {
    std::string path;  // absolute; empty: none
    SceneKind kind{};
};

[[nodiscard]] Dropped meaning_of(const std::vector<std::string>& files, const ShownScene& shown = {});
// One line: "Dock 1abc.pdb into emd.mrc.", "Add 1abc.pdb to this scene.", or the reason against it.
[[nodiscard]] std::string meaning_text(const Dropped& meant);

}  // namespace tact
