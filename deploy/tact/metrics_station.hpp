// The report of tact station verify for Prometheus; also without a controller, because it describes the machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/station/station_report.hpp"

namespace tact::launch {

// Metrics of the present report; without a report, only tact_station_report 0.
[[nodiscard]] std::string station_metrics(const std::string& labels);
[[nodiscard]] std::string station_metrics(const std::string& labels,
                                          const std::optional<StationReport>& report,
                                          const std::string& machine, const std::string& kernel);

}  // namespace tact::launch
