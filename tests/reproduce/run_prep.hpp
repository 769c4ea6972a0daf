// Runs tact-prep for an experiment: without output, with a time limit, and with its output in the error.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

// Writes its output to the file `log`. Throws StartupError "attempt: ..." if it fails or takes a minute.
void run_prep(const std::vector<std::string>& arguments, const std::filesystem::path& log,
              const std::string& attempt);

}  // namespace tact::launch
