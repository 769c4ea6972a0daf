// Runs tact-prep for an experiment, with a time limit. Its output appears only in the message of an error.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

// Writes the output to the file `log`. Throws StartupError "attempt: ..." if tact-prep fails or runs longer than a
// minute.
void run_prep(const std::vector<std::string>& arguments, const std::filesystem::path& log,
              const std::string& attempt);

}  // namespace tact::launch
