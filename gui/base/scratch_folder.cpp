#include "gui/base/scratch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

constexpr const char kName[] = "tact-gui-scratch-";
constexpr const char kLetters[] = "XXXXXX";

bool is_ours_by_name(const std::string& name) {
    return name.size() == sizeof kName + sizeof kLetters - 2 && name.starts_with(kName);
}

// Locks the folder and returns its descriptor; -1 if it is in use, belongs to another user, or is no folder.
int lock_of(const std::filesystem::path& folder) {
    const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0) return -1;
    struct stat is {};
    if (fstat(fd, &is) == 0 && is.st_uid == geteuid() && flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
    close(fd);
    return -1;
}

// Another process may have removed the folder before it was locked.
bool still_there(const std::filesystem::path& folder, int fd) {
    struct stat path {
    }, locked{};
    return lstat(folder.c_str(), &path) == 0 && fstat(fd, &locked) == 0 && path.st_ino == locked.st_ino &&
           path.st_dev == locked.st_dev;
}

void remove_left_over(const std::filesystem::path& parent) {
    std::error_code failed;
    for (std::filesystem::directory_iterator it(parent, failed), end; !failed && it != end;
         it.increment(failed)) {
        if (!is_ours_by_name(it->path().filename().string())) continue;
        const int fd = lock_of(it->path());
        if (fd < 0) continue;
        std::error_code ignored;
        std::filesystem::remove_all(it->path(), ignored);
        close(fd);
    }
}

}  // namespace

ScratchFolder::ScratchFolder(const std::filesystem::path& parent) {
    remove_left_over(parent);
    // Another cleanup may remove the folder between its creation and its lock, but not ten times in a row.
    for (int i = 0; i < 10; ++i)
        if (make(parent)) return;
    throw StartupError("creating a folder for a child program", "no folder can be made in " + parent.string(),
                       "free space there, or set TMPDIR");
}

bool ScratchFolder::make(const std::filesystem::path& parent) {
    std::string name = (parent / kName).string() + kLetters;
    if (mkdtemp(name.data()) == nullptr) return false;
    const int fd = lock_of(name);
    if (fd >= 0 && still_there(name, fd)) {
        path_ = name;
        lock_fd_ = fd;
        return true;
    }
    if (fd >= 0) close(fd);
    return false;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
    close(lock_fd_);
}

}  // namespace tact
