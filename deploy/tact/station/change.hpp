// One change to a file of a machine: what was there before, byte for byte, and what is there afterwards.
//
// Crash   the new content is written beside the file under a fixed name and renamed, so that at any instant the file is
//         as before or as wanted, and what was left beside it is found again.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tact::launch {

enum class FileKind : std::uint8_t { absent, file, link };

struct FileContent {
    FileKind kind = FileKind::absent;
    std::string bytes{};  // of a file; the target of a link
    mode_t mode = 0;      // of a file, permission bits
    uid_t uid = 0;
    gid_t gid = 0;
    bool operator==(const FileContent&) const = default;
};

struct FileChange {
    std::filesystem::path path{};  // below the root that is worked on, without it
    FileContent before{}, after{};
    std::vector<std::filesystem::path> folders{};  // made for it, the outermost first
};

// Throws StartupError for what is neither a file, a link nor absent, or cannot be read.
[[nodiscard]] FileContent read_content(const std::filesystem::path& path);
// Equal in everything that put_content() restores; owners count only where both are known.
void put_content(const std::filesystem::path& path, const FileContent& content);

// Folders above the path that are not there yet, the outermost first, without the root.
[[nodiscard]] std::vector<std::filesystem::path> missing_folders(const std::filesystem::path& root,
                                                                 const std::filesystem::path& path);

// Does it; `interrupt` is called between its parts, for tests.
void apply_change(const std::filesystem::path& root, const FileChange& change, void (*interrupt)());
// Why the change cannot be taken back without losing what somebody wrote since; empty: it can.
[[nodiscard]] std::string changed_since(const std::filesystem::path& root, const FileChange& change);
void revert_change(const std::filesystem::path& root, const FileChange& change);

}  // namespace tact::launch
