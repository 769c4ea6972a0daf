// Baked scenes, kept by content: the same inputs, options and tact-prep give the same file, baked once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

struct BakeRequest {
    std::vector<std::filesystem::path> inputs;  // maps, models, scans; empty for a demo
    std::vector<std::string> words;    // of tact-prep before -o: {"demo","dock"} or {"dock", MAP, MODEL...}
    std::vector<std::string> options;  // and behind it
};

// What a scan is read from: itself, the files of its folder, or a header and the files of its stem beside it.
std::vector<std::filesystem::path> scan_files(const std::filesystem::path& scan);

// The scene's path; runs tact-prep, which shows its progress, where it is not there yet. Throws StartupError
// where the baking fails; returns an empty path where a signal ended it.
std::filesystem::path baked_scene(const BakeRequest& request);

}  // namespace tact::launch
