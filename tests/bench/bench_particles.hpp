// Cost of particles, measured by tact-gui: for `tact bench drilling`. Keys: gui/drilling/bench_particles.hpp.
//
// Without   tact-gui on this machine: returns no keys and prints a message to standard error
// Fails by  StartupError if tact-gui fails
#pragma once

#include <nlohmann/json.hpp>

namespace tact::launch {

nlohmann::json bench_particles_by_child();

}  // namespace tact::launch
