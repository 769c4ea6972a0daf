// Where the window puts what a person asks it to save: pictures, tables, structures, recordings.
//
// Folder   $TACT_OUTPUT, else $HOME/Tact, else the working folder; created when something is saved
// Name     DATE_TIME_WHAT, for example 2026-11-28_085312_picture.png; with -2, -3, ... where that exists
// Errors   StartupError: the folder cannot be created
// Thread   any
#pragma once

#include <filesystem>
#include <string>

namespace tact {

[[nodiscard]] std::filesystem::path output_folder();
// A path that does not exist, in the folder. extension: with its dot; empty: for a folder.
[[nodiscard]] std::filesystem::path new_output(const std::string& what, const std::string& extension);

}  // namespace tact
