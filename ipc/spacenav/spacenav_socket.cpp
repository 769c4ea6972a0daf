#include "ipc/spacenav/spacenav_socket.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>

namespace tact {
namespace {

constexpr int kLinesMost = 1000;  // of /etc/spnavrc
constexpr const char* kBlank = " \t\r\n";

// A line "socket = PATH".
std::optional<std::string> spacenav_path_in(const std::string& line) {
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string::npos || line.compare(begin, 6, "socket") != 0) return std::nullopt;
    const std::size_t equals = line.find('=', begin);
    if (equals == std::string::npos) return std::nullopt;
    const std::size_t first = line.find_first_not_of(kBlank, equals + 1);
    if (first == std::string::npos) return std::nullopt;
    return line.substr(first, line.find_last_not_of(kBlank) - first + 1);
}

SpacenavService try_spacenav(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) return SpacenavService::absent;
    std::memcpy(address.sun_path, path.c_str(), path.size());
    const int s = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (s < 0) return SpacenavService::busy;
    const int error =
        ::connect(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
    ::close(s);
    switch (error) {
        case 0:
            return SpacenavService::answers;
        case EACCES:
        case EPERM:
            return SpacenavService::denied;
        case EAGAIN:
        case EINTR:
            return SpacenavService::busy;
        case ENOENT:
        case ENOTDIR:
            return SpacenavService::absent;
        default:
            return SpacenavService::refuses;
    }
}

}  // namespace

std::vector<std::string> spacenav_paths(const std::filesystem::path& root) {
    std::vector<std::string> paths;
    if (const char* const own = std::getenv("SPNAV_SOCKET"); own != nullptr && *own != '\0')
        paths.emplace_back(own);
    std::ifstream file(root / "etc/spnavrc");
    std::string line;
    for (int i = 0; i < kLinesMost && std::getline(file, line); ++i) {
        const auto path = spacenav_path_in(line);
        if (!path) continue;
        paths.push_back(*path);
        break;
    }
    paths.push_back((root / "var/run/spnav.sock").string());
    return paths;
}

SpacenavFound find_spacenav(const std::filesystem::path& root) {
    SpacenavFound found;
    for (const std::string& path : spacenav_paths(root)) {
        const SpacenavService service = try_spacenav(path);
        if (service == SpacenavService::answers) return {service, path};
        if (found.service == SpacenavService::absent) found = {service, path};
    }
    return found;
}

std::string spacenav_problem(const SpacenavFound& found) {
    switch (found.service) {
        case SpacenavService::absent:
            return "not found. Install and start spacenavd.";
        case SpacenavService::refuses:
            return "spacenavd does not answer at " + found.path +
                   ". Start it again: sudo systemctl restart spacenavd.";
        case SpacenavService::denied:
            return "this user may not connect to " + found.path + ". Check the access rights of that socket.";
        case SpacenavService::busy:
            return "spacenavd takes no connection at " + found.path +
                   ". Start it again: sudo systemctl restart spacenavd.";
        case SpacenavService::answers:
            break;
    }
    return "";
}

}  // namespace tact
