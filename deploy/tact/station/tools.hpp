// Commands that tact station runs on the machine.
#pragma once

#include <string>
#include <vector>

#include "deploy/tact/station/journal.hpp"

namespace tact::launch {

// Its exit code, 127 where it cannot be started, 128 + n where signal n ended it; its output goes to standard error.
int run_command(const Command& command);
// What it prints; nothing where it fails.
[[nodiscard]] std::string output_of(const Command& command);

// Packages that installing the real-time kernel would bring, asked of apt-get without changing anything.
[[nodiscard]] std::vector<std::string> kernel_packages_to_come();
// The lines "Inst NAME ..." of apt-get -s.
[[nodiscard]] std::vector<std::string> parse_simulated_install(const std::string& text);

}  // namespace tact::launch
