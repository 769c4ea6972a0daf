// What particles cost, measured by tact-gui, who moves them: for `tact bench drilling`. Keys: gui/drilling/bench_particles.hpp.
//
// Without   the visual process on this machine: no keys, and a line on standard error that says so
// Fails by  StartupError where it is there and does not do it
#pragma once

#include <nlohmann/json.hpp>

namespace tact::launch {

nlohmann::json bench_particles_by_child();

}  // namespace tact::launch
