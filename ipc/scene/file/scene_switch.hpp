// The window asks its launcher for another scene, through a folder that the launcher made for this run and this user alone.
//
// DIR/open      by the window: the scene's absolute path, one line
// DIR/refused   by the launcher: why the scene that runs goes on, in words
// Each is whole or absent (a temporary file, renamed), bounded, and gone once it was taken: what is read is
// input from another process.
//
// Fails by StartupError.  Thread any but the servo thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace tact {

inline constexpr std::size_t kAskedPathMost = 4096, kRefusalMost = 2048;

void ask_for_scene(const std::filesystem::path& folder, const std::filesystem::path& scene);
// Nothing asked: nothing. Throws where what was asked is no path: it is gone then as well.
[[nodiscard]] std::optional<std::filesystem::path> take_asked_scene(const std::filesystem::path& folder);

void refuse_scene(const std::filesystem::path& folder, const std::string& why);
// Control characters but the end of a line become '?'.
[[nodiscard]] std::optional<std::string> take_refusal(const std::filesystem::path& folder);

}  // namespace tact
