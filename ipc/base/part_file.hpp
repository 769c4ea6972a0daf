// A large file that is whole or absent: written piece by piece under a temporary name in the same folder, then synced and
// renamed.
//
// Errors  StartupError with file, reason and fix; the temporary file is removed.
// Thread  any but the servo thread: it waits for the disk.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "ipc/base/error.hpp"

namespace tact {

class PartFile {
public:
    // what: of the file, for messages, such as "mesh".
    PartFile(const std::filesystem::path& path, const std::string& what)
        : path_(path),
          what_(what),
          beside_(path.string() + ".part" + std::to_string(::getpid())),
          file_(std::fopen(beside_.c_str(), "wbx"), &std::fclose) {
        if (!file_) fail("the temporary file could not be created");
    }
    ~PartFile() { ::unlink(beside_.c_str()); }  // does nothing after the rename
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    void write(std::string_view bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail("writing failed");
    }
    void finish() {
        if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0) fail("writing failed");
        if (std::fclose(file_.release()) != 0) fail("closing failed");
        if (std::rename(beside_.c_str(), path_.c_str()) != 0) fail("renaming failed");
    }

private:
    [[noreturn]] void fail(const char* why) const {
        throw StartupError("write " + what_ + " " + path_.string(), std::string(why) + ": " + last_error(),
                           "check that the folder exists, is writable and has free space");
    }

    std::filesystem::path path_;
    std::string what_, beside_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace tact
