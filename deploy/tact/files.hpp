// Files that the launcher writes and the folders that it keeps them in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tact::launch {

// Whole or absent: a temporary file beside the target, synced and renamed. Makes the folder. Throws
// StartupError.
void write_whole(const std::filesystem::path& path, const std::string& content);

// The first bytes of a small text file such as those of /proc; "" where it cannot be read.
std::string read_small(const std::filesystem::path& path);

// $XDG_CACHE_HOME/tact, else ~/.cache/tact, else a folder of this user in /tmp; made, 0700. Throws
// StartupError.
std::filesystem::path cache_folder();

// A new folder of this user alone, removed with its content when the object goes.
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

// FNV-1a, 64 bit: names cached content; it is no protection against forgery.
class ContentHash {
public:
    void add(const std::string& text);  // with its length, so that ("ab","c") differs from ("a","bc")
    void add_file(const std::filesystem::path& path);  // throws StartupError where it cannot be read
    [[nodiscard]] std::string hex() const;

private:
    void bytes(const char* data, std::size_t size);
    std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace tact::launch
