// Logs the report of tact station verify.
#pragma once

namespace tact {

// Logs whether a report applies to this machine and kernel, and its age. Nothing depends on it.
void log_station_report();

}  // namespace tact
