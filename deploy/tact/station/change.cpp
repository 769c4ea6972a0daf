#include "deploy/tact/station/change.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr const char* kFix = "check the permissions and the free space, then repeat the command";

std::filesystem::path beside(const std::filesystem::path& path) { return path.string() + ".tact-new"; }

std::filesystem::path below(const std::filesystem::path& root, const std::filesystem::path& path) {
    return root / path.relative_path();
}

[[noreturn]] void fail(const char* what, const std::filesystem::path& path) {
    throw StartupError(std::string(what) + " " + path.string(), last_error(), kFix);
}

void sync_folder(const std::filesystem::path& folder) {
    const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    static_cast<void>(fsync(fd));  // some file systems do not support it
    close(fd);
}

void write_file(const std::filesystem::path& path, const FileContent& content) {
    unlink(path.c_str());
    const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0) fail("write", path);
    bool good = true;
    for (std::size_t done = 0; good && done < content.bytes.size();) {
        const ssize_t n = write(fd, content.bytes.data() + done, content.bytes.size() - done);
        good = n > 0 || (n < 0 && errno == EINTR);
        done += n > 0 ? static_cast<std::size_t>(n) : 0;
    }
    // Set the owner first: changing it clears special bits of the mode.
    if (good && geteuid() == 0) good = fchown(fd, content.uid, content.gid) == 0;
    good = good && fchmod(fd, content.mode) == 0 && fsync(fd) == 0;
    const int why = errno;
    close(fd);
    errno = why;
    if (!good) fail("write", path);
}

}  // namespace

FileContent read_content(const std::filesystem::path& path) {
    FileContent content;
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0) {
        if (errno != ENOENT && errno != ENOTDIR) fail("read", path);
        return content;
    }
    content.uid = status.st_uid;
    content.gid = status.st_gid;
    if (S_ISLNK(status.st_mode)) {
        content.kind = FileKind::link;
        content.bytes = std::filesystem::read_symlink(path).string();
        return content;
    }
    if (!S_ISREG(status.st_mode))
        throw StartupError("read " + path.string(), "the path is neither a file nor a link", "remove it");
    content.kind = FileKind::file;
    content.mode = status.st_mode & 07777U;
    std::ifstream in(path, std::ios::binary);
    content.bytes.assign(std::istreambuf_iterator<char>(in), {});
    if (!in) fail("read", path);
    return content;
}

void put_content(const std::filesystem::path& path, const FileContent& content) {
    const std::filesystem::path fresh = beside(path);
    if (content.kind == FileKind::absent) {
        if (unlink(path.c_str()) != 0 && errno != ENOENT) fail("remove", path);
        unlink(fresh.c_str());
        return;
    }
    if (content.kind == FileKind::link) {
        unlink(fresh.c_str());
        if (symlink(content.bytes.c_str(), fresh.c_str()) != 0) fail("write", path);
        if (geteuid() == 0 && lchown(fresh.c_str(), content.uid, content.gid) != 0) fail("write", path);
    } else {
        write_file(fresh, content);
    }
    if (rename(fresh.c_str(), path.c_str()) != 0) fail("write", path);
    sync_folder(path.parent_path());
}

std::vector<std::filesystem::path> missing_folders(const std::filesystem::path& root,
                                                   const std::filesystem::path& path) {
    std::vector<std::filesystem::path> missing;
    std::filesystem::path folder;
    for (const auto& part : path.parent_path().relative_path()) {
        folder /= part;
        if (!std::filesystem::is_directory(root / folder)) missing.push_back(folder);
    }
    return missing;
}

void apply_change(const std::filesystem::path& root, const FileChange& change, void (*interrupt)()) {
    for (const auto& folder : change.folders) {
        if (mkdir(below(root, folder).c_str(), 0755) != 0 && errno != EEXIST)
            fail("make folder", below(root, folder));
        if (chmod(below(root, folder).c_str(), 0755) != 0) fail("make folder", below(root, folder));
        interrupt();
    }
    if (change.after.kind == FileKind::file) {  // the state that a crash would leave
        write_file(beside(below(root, change.path)), change.after);
        interrupt();
    }
    put_content(below(root, change.path), change.after);
}

std::string changed_since(const std::filesystem::path& root, const FileChange& change) {
    const std::filesystem::path path = below(root, change.path);
    const FileContent now = read_content(path);
    if (now == change.after || now == change.before) return {};
    if (now.kind == FileKind::absent) return path.string() + " was removed";
    return path.string() + (now.bytes == change.after.bytes ? " has another mode or owner" : " was edited") +
           " since tact station setup";
}

void revert_change(const std::filesystem::path& root, const FileChange& change) {
    const std::filesystem::path path = below(root, change.path);
    unlink(beside(path).c_str());
    if (read_content(path) != change.before) put_content(path, change.before);
    for (auto folder = change.folders.rbegin(); folder != change.folders.rend(); ++folder)
        rmdir(below(root, *folder).c_str());  // a folder with other content is kept
}

}  // namespace tact::launch
