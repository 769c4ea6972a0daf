#include "deploy/tact/files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact::launch {
namespace {

std::filesystem::path user_folder_in_tmp() { return "/tmp/tact-cache-" + std::to_string(getuid()); }

}  // namespace

void write_whole(const std::filesystem::path& path, const std::string& content) {
    write_whole_file(path, content);
}

std::string read_small(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text(65536, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    return text;
}

std::filesystem::path cache_folder() {
    const char* const xdg = std::getenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    std::filesystem::path folder;
    if (xdg != nullptr && xdg[0] == '/') {
        folder = std::filesystem::path(xdg) / "tact";
    } else if (home != nullptr && home[0] == '/') {
        folder = std::filesystem::path(home) / ".cache" / "tact";
    } else {
        folder = user_folder_in_tmp();
    }
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    struct stat info {};
    if (failed || stat(folder.c_str(), &info) != 0 || info.st_uid != getuid() ||
        access(folder.c_str(), W_OK) != 0)
        throw StartupError("using the cache folder " + folder.string(),
                           failed ? failed.message() : "the path is not a writable folder of this user",
                           "set XDG_CACHE_HOME to a folder of your own");
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all, failed);
    return folder;
}

ScratchFolder::ScratchFolder() {
    std::error_code failed;
    std::string name = (std::filesystem::temp_directory_path(failed) / "tact-run-XXXXXX").string();
    if (failed || mkdtemp(name.data()) == nullptr)
        throw StartupError("making a temporary folder", std::strerror(errno),
                           "set TMPDIR to a writable folder");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

void ContentHash::bytes(const char* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
        state_ = (state_ ^ static_cast<unsigned char>(data[i])) * 1099511628211ULL;
}

void ContentHash::add(const std::string& text) {
    const std::string length = std::to_string(text.size()) + ":";
    bytes(length.data(), length.size());
    bytes(text.data(), text.size());
}

void ContentHash::add_file(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::vector<char> some(1U << 20U);
    std::uint64_t total = 0;
    while (in.read(some.data(), static_cast<std::streamsize>(some.size())) || in.gcount() > 0) {
        bytes(some.data(), static_cast<std::size_t>(in.gcount()));
        total += static_cast<std::uint64_t>(in.gcount());
    }
    if (!in.eof() || std::filesystem::is_directory(path))
        throw StartupError("reading " + path.string(), std::strerror(errno != 0 ? errno : EISDIR),
                           "check the path and the permissions of the file");
    add(std::to_string(total));
}

std::string ContentHash::hex() const {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(state_));
    return text.data();
}

}  // namespace tact::launch
