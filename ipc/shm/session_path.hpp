// Where a session's socket and lock file lie, and whether that place can be trusted.
//
// Trust   the folder belongs to this user or to root, and nobody else may write there; otherwise a stranger
//         could stand in for the controller.
#pragma once

#include <string>

namespace tact {

struct SessionPaths {
    std::string folder;
    std::string socket;
    std::string lock;
};

// Throws StartupError: a name that is no name, a path too long for a socket.
[[nodiscard]] SessionPaths session_paths(const std::string& session);

// Makes the folder (0700) if it is absent. Throws StartupError if it cannot be made or trusted.
void make_runtime_folder(const std::string& folder);

// Empty if the folder can be trusted, else why not. Never throws for what it finds.
[[nodiscard]] std::string distrust_runtime_folder(const std::string& folder);

[[nodiscard]] bool is_session_name(const std::string& name);

}  // namespace tact
