// The folder for what Tact keeps of a user between runs.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace tact {

// $XDG_STATE_HOME/tact, else ~/.local/state/tact; empty: neither variable is set.
[[nodiscard]] inline std::filesystem::path state_folder() {
    const auto folder_of = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::filesystem::path(value != nullptr && value[0] == '/' ? value : "");
    };
    if (const auto xdg = folder_of("XDG_STATE_HOME"); !xdg.empty()) return xdg / "tact";
    if (const auto home = folder_of("HOME"); !home.empty()) return home / ".local" / "state" / "tact";
    return {};
}

}  // namespace tact
