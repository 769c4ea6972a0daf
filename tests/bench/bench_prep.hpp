// Cost and quality of mesh simplification on this machine, measured by tact-prep.
#pragma once

#include <nlohmann/json.hpp>

namespace tact::launch {

// Returns the result of `tact-prep bench --json`. Takes about three seconds. Throws StartupError if tact-prep fails.
[[nodiscard]] nlohmann::json bench_prep();

}  // namespace tact::launch
