// tact-rt --check-config FILE: what is wrong with a configuration, without a scene and without opening a device.
//
// Reader   the controller's own (rt/config/config.hpp), and besides whether this machine has the core of servo.core.
// JSON     {"ok", "file", "problems": [{"where", "key", "problem", "fix"}], "values": {"servo.core": -1, ...}}; of a key
//          that is wrong, values has what was read or else the default. [arm] is checked and not listed.
// Thread   start-up only
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "rt/config/config.hpp"

namespace tact {

// All that is wrong: what is read, in the order of the file, then what does not fit together or this machine. root: stands for /.
[[nodiscard]] ConfigErrors check_config_file(const std::string& path, RtConfig& config,
                                             const std::filesystem::path& root = "/");
// Writes the answer; returns the exit code: 0 nothing is wrong, 1 something is.
int print_config_check(std::ostream& out, const std::string& path, bool as_json);

}  // namespace tact
