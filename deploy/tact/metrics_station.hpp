// The report of tact station verify for Prometheus; also without a controller, as it is about the machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/station/station_report.hpp"

namespace tact::launch {

// Of the report that is in place now; where there is none, tact_station_report is 0 and nothing else is exported.
[[nodiscard]] std::string station_metrics(const std::string& labels);
[[nodiscard]] std::string station_metrics(const std::string& labels,
                                          const std::optional<StationReport>& report,
                                          const std::string& machine, const std::string& kernel);

}  // namespace tact::launch
