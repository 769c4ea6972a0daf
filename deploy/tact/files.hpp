// Files that the launcher writes, and their folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tact::launch {

// The file is whole or absent: written to a temporary file in the same folder, synced and renamed. Creates the folder.
// Throws StartupError.
void write_whole(const std::filesystem::path& path, const std::string& content);

// The first bytes of a small text file such as those of /proc; "" if it cannot be read.
std::string read_small(const std::filesystem::path& path);

// $XDG_CACHE_HOME/tact, else ~/.cache/tact, else a folder of this user in /tmp; created with mode 0700. Throws
// StartupError.
std::filesystem::path cache_folder();

// A new folder with access for this user only; the destructor removes it with its content.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// FNV-1a, 64 bit: identifies cached content; does not protect against forgery.
class ContentHash {
public:
    void add(const std::string& text);  // includes the length, so that ("ab","c") differs from ("a","bc")
    void add_file(const std::filesystem::path& path);  // throws StartupError if unreadable
    [[nodiscard]] std::string hex() const;

private:
    void bytes(const char* data, std::size_t size);
    std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace tact::launch
