// Recently used scenes, newest first, in a small JSON file of this user: written by the window, also read by the replay,
// which looks there for the scene of a recording.
//
// File     {"scenes": [{"path": "/...", "used_unix_s": 1793000000}, ...]}; at most kRecentsMost, written completely
//          or not at all
// Fails by StartupError; an unreadable file is reported.  Thread any; it waits for the disk.
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

[[nodiscard]] std::vector<RecentScene> read_recents_text(std::string_view text, const std::string& name);
[[nodiscard]] std::string recents_text(const std::vector<RecentScene>& scenes);
// $XDG_STATE_HOME/tact/recent.json, else below ~/.local/state; empty: neither variable is set.
[[nodiscard]] std::filesystem::path recents_file();
// A missing file: none.
[[nodiscard]] std::vector<RecentScene> read_recents(const std::filesystem::path& file);

// Renames an unreadable file to FILE.damaged, replacing an older one; a new list is written afterwards. Returns the
// new name.
std::filesystem::path set_aside(const std::filesystem::path& file);

// Puts the scene in front, once; drops the oldest if there are too many.
[[nodiscard]] std::vector<RecentScene> with_recent(std::vector<RecentScene> scenes, RecentScene used);

}  // namespace tact
