// The folders for what Tact keeps of a user between runs, and for the user's own settings.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace tact {

// variable, else below_home in the home folder, each with "tact" below it; empty: neither variable is set.
[[nodiscard]] inline std::filesystem::path user_folder(const char* variable, const char* below_home) {
    const auto folder_of = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::filesystem::path(value != nullptr && value[0] == '/' ? value : "");
    };
    if (const auto xdg = folder_of(variable); !xdg.empty()) return xdg / "tact";
    if (const auto home = folder_of("HOME"); !home.empty()) return home / below_home / "tact";
    return {};
}

// $XDG_STATE_HOME/tact, else ~/.local/state/tact.
[[nodiscard]] inline std::filesystem::path state_folder() {
    return user_folder("XDG_STATE_HOME", ".local/state");
}

// $XDG_CONFIG_HOME/tact, else ~/.config/tact.
[[nodiscard]] inline std::filesystem::path config_folder() {
    return user_folder("XDG_CONFIG_HOME", ".config");
}

}  // namespace tact
