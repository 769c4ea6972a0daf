// Rows of the scene list: the type of each file, without reading all of it.
//
// Fails by a message in the row.  Thread a worker's: a folder may lie on a slow disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gui/window/browser_panel.hpp"
#include "ipc/scene/session/recent_scenes.hpp"

namespace tact {

inline constexpr std::size_t kFolderRowsMost = 500;

struct FolderRows {
    std::vector<SceneRow>
        rows;  // parent folder, the folder itself if it is a scan, folders, scenes, raw data; by name
    std::string trouble;
};

// used_unix_s: 0 for the file's own time.
[[nodiscard]] SceneRow scene_row_of(const std::filesystem::path& path, std::int64_t used_unix_s,
                                    std::int64_t now_unix_s);
[[nodiscard]] std::vector<SceneRow> recent_rows(const std::vector<RecentScene>& scenes,
                                                std::int64_t now_unix_s);
// Files of drilled bone of a scene, newest first.
[[nodiscard]] std::vector<SceneRow> drilled_rows(const std::filesystem::path& folder,
                                                 std::uint64_t scene_checksum, std::int64_t now_unix_s);
[[nodiscard]] FolderRows folder_rows(const std::filesystem::path& folder, std::int64_t now_unix_s);

// "820 kB", "12.3 MB"
[[nodiscard]] std::string size_text(std::uint64_t bytes);
// "just now", "5 min ago", "3 h ago", "2026-11-20"
[[nodiscard]] std::string ago_text(std::int64_t then_unix_s, std::int64_t now_unix_s);

}  // namespace tact
