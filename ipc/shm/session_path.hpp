// Location of a session's socket and lock file, and the check whether it can be trusted.
//
// Trust   the folder belongs to this user or to root, and nobody else may write to it; otherwise another
//         user could impersonate the controller
// Group   with TACT_RUNTIME_GROUP set (name or number) on both sides: the controller also accepts the
//         group's members, and a member accepts the controller of a folder that root placed, that has this
//         group and that belongs to the user of the controller. This allows the controller of a station to
//         run as its own user.
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

// Throws StartupError for an invalid name, or a path too long for a socket.
[[nodiscard]] SessionPaths session_paths(const std::string& session);

// From TACT_RUNTIME_GROUP; nothing if unset. Throws StartupError if the group does not exist.
[[nodiscard]] std::optional<std::uint32_t> session_group();

// Creates the folder (0700, with a group 0750) if it is absent. Throws StartupError on failure or distrust.
void make_runtime_folder(const std::string& folder, std::optional<std::uint32_t> group = std::nullopt);

// Empty if the folder can be trusted, otherwise the reason. Never throws for the folder's state.
[[nodiscard]] std::string distrust_runtime_folder(const std::string& folder,
                                                  std::optional<std::uint32_t> group = std::nullopt);

[[nodiscard]] bool is_session_name(const std::string& name);

}  // namespace tact
