// Whether a file can be written where the user wants it: found before minutes of work, not after them.
#pragma once

#include <string>
#include <vector>

namespace tact {

// `attempt` in words: "write scene". Throws StartupError when `path` is a folder, one of `inputs`, or in a
// folder that is absent or may not be written to.
void check_target(const std::string& attempt, const std::string& path,
                  const std::vector<std::string>& inputs);

}  // namespace tact
