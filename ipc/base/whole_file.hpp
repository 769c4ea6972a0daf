// Writes a small file completely or not at all: a temporary file beside the target, synced and renamed.
//
// Errors  StartupError; an existing file stays unchanged.
// Thread  any but the servo thread: it waits for the disk.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {

// In an existing folder.
inline void replace_file(const std::filesystem::path& path, const std::string& content) {
    constexpr const char* kFix = "free disk space, correct the permissions, or choose another path";
    std::string temporary = path.string() + ".XXXXXX";
    const int fd = mkostemp(temporary.data(), O_CLOEXEC);
    if (fd < 0) throw StartupError("writing " + path.string(), last_error(), kFix);
    std::size_t done = 0;
    bool ok = fchmod(fd, 0644) == 0;
    while (ok && done < content.size()) {
        const ssize_t n = write(fd, content.data() + done, content.size() - done);
        if (n < 0 && errno == EINTR) continue;
        ok = n > 0;
        done += ok ? static_cast<std::size_t>(n) : 0;
    }
    ok = ok && fsync(fd) == 0;
    int why = errno;
    close(fd);
    if (ok && std::rename(temporary.c_str(), path.c_str()) == 0) return;
    if (ok) why = errno;
    unlink(temporary.c_str());
    throw StartupError("writing " + path.string(), std::system_category().message(why), kFix);
}

// Creates the folder if it does not exist.
inline void write_whole_file(const std::filesystem::path& path, const std::string& content) {
    std::error_code failed;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failed);
    replace_file(path, content);
}

}  // namespace tact
