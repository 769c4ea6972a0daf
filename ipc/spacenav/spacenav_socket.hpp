// Whether spacenavd, the daemon of SpaceMice, answers on this machine.
//
// Paths     those of libspnav in its order: $SPNAV_SOCKET, "socket = PATH" in /etc/spnavrc, /var/run/spnav.sock
// No wait   a connection that would have to wait is not made; nothing is sent
// Thread    any. Throws only when memory is exhausted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tact {

enum class SpacenavService : std::uint8_t {
    absent,   // no socket
    refuses,  // a socket that nobody listens at: the daemon died
    denied,   // this user may not connect
    busy,     // listens, and takes no connection now
    answers,
};

struct SpacenavFound {
    SpacenavService service = SpacenavService::absent;
    std::string path;  // the one that answers, else the first one that exists, else the last one tried
};

// root: of the tree with etc/spnavrc and var/run; "/" except in tests.
[[nodiscard]] std::vector<std::string> spacenav_paths(const std::filesystem::path& root = "/");
[[nodiscard]] SpacenavFound find_spacenav(const std::filesystem::path& root = "/");
// "" while it answers; else what is wrong and the fix, for a person.
[[nodiscard]] std::string spacenav_problem(const SpacenavFound& found);

}  // namespace tact
