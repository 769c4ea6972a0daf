// Drilling in the report of a run: the tools and the removed bone, from the controller, and the trainee's metrics, from
// the window.
//
// Keys are stable, units are in the names; unknown values are null.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ipc/topics/regions.hpp"

namespace tact::launch {

// Null without drilling. trainee: the file of tact-gui --report; null in the report if there is none.
nlohmann::json drilling_report(const RtRegion& region, const std::filesystem::path& trainee);
// The text lines of the report above.
std::string drilling_summary(const nlohmann::json& drilling);

}  // namespace tact::launch
