// The JSON report of a run, composed from the controller's topics and tact's own observations.
//
// Keys are stable; unknown numbers are null. Units are in the names. Same terms as in the topics.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::launch {

struct RunDescription {
    std::filesystem::path scene;
    std::string session;
    double length_s = 0.0;                  // time for which the controller was seen
    std::string why_ended;                  // "the time is over", "the window was closed", ...
    bool intended = false;                  // all ended as requested
    std::map<std::string, Ending> endings;  // by program
    std::optional<double> fps_median;       // over the samples in which a window was drawing
};

// May take a second if the system computes a result (docking: the fit).
nlohmann::json run_report(const RtRegion* region, const SystemRun& system, const RunDescription& description);

// The state of a controller, for `tact status`.
nlohmann::json controller_report(const RtRegion& region);

std::string report_text(const nlohmann::json& report);  // as a file: indented, ends with a newline
// The lines that a person reads at the end of a run.
std::string report_summary(const nlohmann::json& report);

}  // namespace tact::launch
