// What simplification costs on this machine and how good it is: asked of tact-prep, which alone can do it.
#pragma once

#include <nlohmann/json.hpp>

namespace tact::launch {

// The numbers of `tact-prep bench --json`. Takes about three seconds. Throws StartupError where it fails.
[[nodiscard]] nlohmann::json bench_prep();

}  // namespace tact::launch
