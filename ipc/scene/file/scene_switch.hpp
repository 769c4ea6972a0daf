// Lets the window request another scene from its launcher, through a folder that the launcher created for
// this run and user.
//
// DIR/open      by the window: the scene's absolute path, one line
// DIR/demo      by the start page: the name of a demo, one word of lower-case letters
// DIR/past      by the window: how many seconds ago the moment is that a person wants to look back to
// DIR/added.tact-session, DIR/shown.tact-session   by the window, before it asks for the first: the session that continues in the scene with
//               more structures, and the one to go back to if that scene does not start
// DIR/refused   by the launcher: the reason for which the present scene continues
// Each file is complete or absent (a temporary file, renamed), bounded, and removed when read: its content is
// untrusted input from another process.
//
// Errors   StartupError
// Thread   any but the servo thread
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace tact {

inline constexpr const char *kAddedSession = "added.tact-session", *kShownSession = "shown.tact-session";
inline constexpr std::size_t kAskedPathMost = 4096, kRefusalMost = 2048, kDemoNameMost = 16;
inline constexpr double kPastMostS = 600.0;

void ask_for_scene(const std::filesystem::path& folder, const std::filesystem::path& scene);
// Nothing without a request. Throws for a request without a valid path, which is removed too.
[[nodiscard]] std::optional<std::filesystem::path> take_asked_scene(const std::filesystem::path& folder);

void ask_for_demo(const std::filesystem::path& folder, const std::string& name);
// Nothing without a request. Throws for a request that is not such a word, which is removed too.
[[nodiscard]] std::optional<std::string> take_asked_demo(const std::filesystem::path& folder);

void ask_for_past(const std::filesystem::path& folder, double ago_s);
// Nothing without a request. Throws for one that is no time up to kPastMostS, which is removed too.
[[nodiscard]] std::optional<double> take_asked_past(const std::filesystem::path& folder);

void refuse_scene(const std::filesystem::path& folder, const std::string& why);
// Control characters except newlines become '?'.
[[nodiscard]] std::optional<std::string> take_refusal(const std::filesystem::path& folder);

}  // namespace tact
