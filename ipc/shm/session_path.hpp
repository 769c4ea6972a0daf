// Where a session's socket and lock file lie, and whether that place can be trusted.
//
// Trust   the folder belongs to this user or to root, and nobody else may write there; otherwise a stranger
//         could stand in for the controller.
// Group   where TACT_RUNTIME_GROUP names a group (by name or number), on both sides: the controller also accepts its
//         members, and a member accepts the controller of a folder that root placed there, has this group and belongs to
//         the user that the controller runs as. The controller of a station runs as a user of its own this way.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tact {

struct SessionPaths {
    std::string folder;
    std::string socket;
    std::string lock;
};

// Throws StartupError: a name that is no name, a path too long for a socket.
[[nodiscard]] SessionPaths session_paths(const std::string& session);

// Of TACT_RUNTIME_GROUP; nothing where it is not set. Throws StartupError: there is no such group.
[[nodiscard]] std::optional<std::uint32_t> session_group();

// Makes the folder (0700, with a group 0750) if it is absent. Throws StartupError if it cannot be made or trusted.
void make_runtime_folder(const std::string& folder, std::optional<std::uint32_t> group = std::nullopt);

// Empty if the folder can be trusted, else why not. Never throws for what it finds.
[[nodiscard]] std::string distrust_runtime_folder(const std::string& folder,
                                                  std::optional<std::uint32_t> group = std::nullopt);

[[nodiscard]] bool is_session_name(const std::string& name);

}  // namespace tact
