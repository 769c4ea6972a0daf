// Cache of baked scenes by content: the same inputs, options and tact-prep give the same file, baked once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct BakeRequest {
    std::vector<std::filesystem::path> inputs;  // maps, models, scans; empty for a demo
    std::vector<std::string> words;    // of tact-prep before -o: {"demo","dock"} or {"dock", MAP, MODEL...}
    std::vector<std::string> options;  // arguments after -o
};

// The files of a scan: the file itself, all files of a folder, or a header and the files of the same stem beside it.
std::vector<std::filesystem::path> scan_files(const std::filesystem::path& scan);

// Returns the scene's path. Runs tact-prep, which shows its progress, if the scene is not cached. Throws StartupError
// if baking fails; returns an empty path if a signal ended it.
std::filesystem::path baked_scene(const BakeRequest& request);

}  // namespace tact::launch
