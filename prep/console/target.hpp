// Checks that an output file can be written, before the long work starts.
#pragma once

#include <string>
#include <vector>

namespace tact {

// `attempt` is the first part of the error text: "write scene". Throws StartupError if `path` is a folder, one of
// `inputs`, or in a folder that is absent or not writable.
void check_target(const std::string& attempt, const std::string& path,
                  const std::vector<std::string>& inputs);

}  // namespace tact
