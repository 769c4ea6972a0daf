// What a run's report says of drilling: the tools and what they took, from the controller, and a trainee's figures, from the
// window.
//
// Keys are stable, units are in the names; what is not known is null.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/topics/regions.hpp"

namespace tact::launch {

// Null where nothing is drilled. trainee: what tact-gui --report wrote; null in the report where it did not.
nlohmann::json drilling_report(const RtRegion& region, const std::filesystem::path& trainee);
// The lines that a person reads; of the above.
std::string drilling_summary(const nlohmann::json& drilling);

}  // namespace tact::launch
