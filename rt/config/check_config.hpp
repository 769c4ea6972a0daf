// tact-rt --check-config FILE: lists the problems of a configuration without a scene and without opening a device.
//
// Reader   the controller's own reader (rt/config/config.hpp); also checks that this machine has the core servo.core.
// JSON     {"ok", "file", "problems": [{"where", "key", "problem", "fix"}], "values": {"servo.core": -1, ...}}. For a
//          rejected key, values holds the value read, or else the default. [arm] is checked but not listed.
// Thread   start-up only
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "rt/config/config.hpp"

namespace tact {

// Returns all problems: first those of single lines, in file order, then conflicts between keys and with this
// machine. root replaces "/" (for tests).
[[nodiscard]] ConfigErrors check_config_file(const std::string& path, RtConfig& config,
                                             const std::filesystem::path& root = "/");
// Prints the report; returns the exit code: 0 without problems, else 1.
int print_config_check(std::ostream& out, const std::string& path, bool as_json);

}  // namespace tact
