#include "ipc/shm/session_path.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <system_error>

#include "ipc/base/error.hpp"
#include "ipc/shm/link.hpp"

namespace tact {
namespace {

constexpr std::size_t kSessionNameMax = 48;

std::string runtime_folder() {
    for (const char* const variable : {"TACT_RUNTIME_DIR", "XDG_RUNTIME_DIR"}) {
        const char* const value = std::getenv(variable);  // at start-up, before other threads exist
        if (value != nullptr && *value != '\0') return value;
    }
    return "/tmp/tact-" + std::to_string(geteuid());
}

// True if only root can create entries in the parent folder, so that nobody else chose the owner.
bool placed_by_root(const std::string& folder) {
    struct stat status {};
    return lstat((folder + "/..").c_str(), &status) == 0 && status.st_uid == 0 &&
           (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace

bool is_session_name(const std::string& name) {
    return !name.empty() && name.size() <= kSessionNameMax && name.front() != '.' &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '-' || c == '_' || c == '.';
           });
}

SessionPaths session_paths(const std::string& session) {
    const std::string attempt = "find session \"" + session + "\"";
    if (!is_session_name(session))
        throw StartupError(
            attempt, "this is not a valid session name",
            "use 1 to " + std::to_string(kSessionNameMax) + " of a-z A-Z 0-9 - _ . (no leading dot)");
    SessionPaths p;
    p.folder = runtime_folder();
    p.socket = p.folder + "/tact-" + session + ".sock";
    p.lock = p.folder + "/tact-" + session + ".lock";
    if (p.socket.size() >= sizeof(sockaddr_un::sun_path))
        throw StartupError(attempt, "the path " + p.socket + " is too long for a socket",
                           "set TACT_RUNTIME_DIR to a folder with a shorter name");
    return p;
}

std::optional<std::uint32_t> session_group() {
    const char* const value = std::getenv("TACT_RUNTIME_GROUP");
    if (value == nullptr || *value == '\0') return std::nullopt;
    const std::string name = value;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && end == name.data() + name.size()) return number;
    const group* const found = getgrnam(value);  // at start-up
    if (found == nullptr)
        throw StartupError("find group " + name + " of TACT_RUNTIME_GROUP", "the group does not exist",
                           "create it with tact station setup, or unset TACT_RUNTIME_GROUP");
    return found->gr_gid;
}

std::string session_socket_path(const std::string& session) { return session_paths(session).socket; }

void make_runtime_folder(const std::string& folder, std::optional<std::uint32_t> group) {
    const std::string fix = "set TACT_RUNTIME_DIR to a folder that you own (chmod 700)";
    const bool made = mkdir(folder.c_str(), 0700) == 0;
    if (!made && errno != EEXIST) throw StartupError("create folder " + folder, last_error(), fix);
    if (made && group &&
        (chown(folder.c_str(), static_cast<uid_t>(-1), *group) != 0 || chmod(folder.c_str(), 0750) != 0))
        throw StartupError("assign folder " + folder + " to group " + std::to_string(*group), last_error(),
                           "run as a member of that group, or unset TACT_RUNTIME_GROUP");
    const std::string why = distrust_runtime_folder(folder);
    if (!why.empty()) throw StartupError("use folder " + folder, why, fix);
}

std::string distrust_runtime_folder(const std::string& folder, std::optional<std::uint32_t> group) {
    struct stat status {};
    if (lstat(folder.c_str(), &status) != 0) return last_error();
    if (!S_ISDIR(status.st_mode)) return "it is not a folder (links are not followed)";
    const bool for_group = group && status.st_gid == *group && placed_by_root(folder);
    if (status.st_uid != geteuid() && status.st_uid != 0 && !for_group)
        return "it belongs to user " + std::to_string(status.st_uid) + ", not to user " +
               std::to_string(geteuid());
    if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "other users may write to it";
    return {};
}

}  // namespace tact
