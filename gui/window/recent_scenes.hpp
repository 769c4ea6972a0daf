// The scenes that were used, newest first, in a small JSON file of this user.
//
// File     {"scenes": [{"path": "/...", "used_unix_s": 1793000000}, ...]}; at most kRecentsMost, whole or absent
// Fails by StartupError; what cannot be read is told and never guessed at.  Thread any; it waits for the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tact {

struct RecentScene {
    std::string path;  // absolute
    std::int64_t used_unix_s = 0;
    bool operator==(const RecentScene&) const = default;
};

inline constexpr std::size_t kRecentsMost = 24, kRecentsBytesMost = std::size_t{256} * 1024;

// $XDG_STATE_HOME/tact, else ~/.local/state/tact; empty: neither is said.
[[nodiscard]] std::filesystem::path state_folder();

[[nodiscard]] std::vector<RecentScene> read_recents_text(std::string_view text, const std::string& name);
[[nodiscard]] std::string recents_text(const std::vector<RecentScene>& scenes);
// Of a file that is not there: none.
[[nodiscard]] std::vector<RecentScene> read_recents(const std::filesystem::path& file);

// A file that cannot be read becomes FILE.damaged, in the place of one that was there, and is written anew then. Returns
// where it is.
std::filesystem::path set_aside(const std::filesystem::path& file);

// The scene in front, once; the oldest goes where there are too many.
[[nodiscard]] std::vector<RecentScene> with_recent(std::vector<RecentScene> scenes, RecentScene used);

}  // namespace tact
