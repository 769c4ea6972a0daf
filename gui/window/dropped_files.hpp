// What files mean that a person drops onto the window or marks in a list: a scene to open, or raw data that `tact` bakes
// into one.
//
// By their endings alone, which ipc/scene/file/scene_kinds lists; what is in them is for tact-prep to say.  Fails by words.  Thread any.
#pragma once

#include <string>
#include <vector>

namespace tact {

inline constexpr std::size_t kDroppedMost = 17;  // a map and as many structures as a scene holds

// What can be dropped, as a sentence.
[[nodiscard]] const std::string& dropped_kinds_text();

// The type of a raw file ("map", "mesh", ...) by the ending of its name, empty where no system reads it; no disk is asked.
[[nodiscard]] const char* raw_file_text(const std::string& name);
// Of a folder that stands for one file: of DICOM files or pictures.
[[nodiscard]] const char* raw_folder_text();

struct Dropped {
    std::string scene;                // to open
    std::vector<std::string> import;  // arguments of `tact`: {"dock", MAP, MODEL...}, {"touch", MESH}, ...
    std::string trouble;              // what cannot be done, why, and what to do instead
};

[[nodiscard]] Dropped meaning_of(const std::vector<std::string>& files);
// One line: "Dock 1abc.pdb into emd.mrc.", or what is in the way.
[[nodiscard]] std::string meaning_text(const Dropped& meant);

}  // namespace tact
