// The report of a trainee's session as JSON. Keys are stable, units are in the names; what is not known is null.
//
// Errors   write_drill_report: StartupError that names the file
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "gui/drilling/drill_metrics.hpp"

namespace tact {

// Of the time that the burr turned in bone, how long it could be seen for blood, dust and water.
struct BurrVisibility {
    double drilling_s = 0.0, seen_s = 0.0;
};

[[nodiscard]] nlohmann::json drill_report(const DrillMetricsRow& metrics, const BoneLabelsView& labels,
                                          const std::optional<BurrVisibility>& visibility);
// Whole or not at all.
void write_drill_report(const std::string& path, const nlohmann::json& report);

}  // namespace tact
