// The configuration that a system's installation has: PREFIX/etc/tact/tact.toml, where tact runs from PREFIX/bin;
// /etc/tact/tact.toml for the prefix /usr. A build folder has none, so a run from it uses the built-in defaults.
#pragma once

#include <filesystem>

namespace tact::launch {

// Empty where there is none. `program`: the running tact.
[[nodiscard]] std::filesystem::path installed_config(const std::filesystem::path& program);
[[nodiscard]] std::filesystem::path installed_config();

}  // namespace tact::launch
