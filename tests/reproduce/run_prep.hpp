// tact-prep as an experiment needs it: quiet, soon done, and an error with what it said.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tact::launch {

// Its output goes to the file `log`. Throws StartupError "attempt: ... " where it fails or takes a minute.
void run_prep(const std::vector<std::string>& arguments, const std::filesystem::path& log,
              const std::string& attempt);

}  // namespace tact::launch
