// Commands that tact station runs on the machine.
#pragma once

#include <string>
#include <vector>

#include "deploy/tact/station/journal.hpp"

namespace tact::launch {

// Returns the exit code, 127 if it cannot be started, 128 + n after signal n. The output goes to standard error.
int run_command(const Command& command);
// Returns the output; empty if the command fails.
[[nodiscard]] std::string output_of(const Command& command);

// Packages that installing the real-time kernel would add, from a simulation by apt-get.
[[nodiscard]] std::vector<std::string> kernel_packages_to_come();
// Parses the lines "Inst NAME ..." of apt-get -s.
[[nodiscard]] std::vector<std::string> parse_simulated_install(const std::string& text);

}  // namespace tact::launch
