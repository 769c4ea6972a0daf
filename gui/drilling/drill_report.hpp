// Report of a trainee's session as JSON. Keys are stable, with units in their names; unknown values are null.
//
// Errors   write_drill_report: StartupError that names the file
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "gui/drilling/drill_metrics.hpp"
#include "ipc/scene/bone/patient_frame.hpp"

namespace tact {

// Time that the burr turned in bone, and the part of it during which blood, dust and water left it visible.
struct BurrVisibility {
    double drilling_s = 0.0, seen_s = 0.0;
};

[[nodiscard]] nlohmann::json drill_report(const DrillMetricsRow& metrics, const BoneLabelsView& labels,
                                          const std::optional<BurrVisibility>& visibility,
                                          const std::optional<PatientFrame>& patient = {});
// Written completely or not at all.
void write_drill_report(const std::string& path, const nlohmann::json& report);

}  // namespace tact
