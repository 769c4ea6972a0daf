// One change to a file of a machine: its content before, byte for byte, and after.
//
// Crash   the new content is written beside the file under a fixed name and renamed, so that at any instant the file
//         has the old or the new content, and a leftover file is found again.
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
    std::filesystem::path path{};  // relative to the root
    FileContent before{}, after{};
    std::vector<std::filesystem::path> folders{};  // created for the file, the outermost first
};

// Throws StartupError if the path is neither a file, a link nor absent, or cannot be read.
[[nodiscard]] FileContent read_content(const std::filesystem::path& path);
// Makes the path equal to `content`. Sets the owner only as root.
void put_content(const std::filesystem::path& path, const FileContent& content);

// Missing folders above the path, the outermost first, without the root.
[[nodiscard]] std::vector<std::filesystem::path> missing_folders(const std::filesystem::path& root,
                                                                 const std::filesystem::path& path);

// Applies the change; `interrupt` is called between its parts, for tests.
void apply_change(const std::filesystem::path& root, const FileChange& change, void (*interrupt)());
// Why the change cannot be reverted without losing later edits; empty: it can.
[[nodiscard]] std::string changed_since(const std::filesystem::path& root, const FileChange& change);
void revert_change(const std::filesystem::path& root, const FileChange& change);

}  // namespace tact::launch
