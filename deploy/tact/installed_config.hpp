// The configuration of an installation: PREFIX/etc/tact/tact.toml if tact runs from PREFIX/bin; /etc/tact/tact.toml for
// the prefix /usr. A build folder has none, so a run from it uses the built-in defaults.
#pragma once

#include <filesystem>

namespace tact::launch {

// Empty if there is none. `program`: path of the running tact.
[[nodiscard]] std::filesystem::path installed_config(const std::filesystem::path& program);
[[nodiscard]] std::filesystem::path installed_config();

}  // namespace tact::launch
