// The report of tact station verify in the log of the controller.
#pragma once

namespace tact {

// Logs whether one applies to this machine and kernel, and how old it is. Nothing depends on it.
void log_station_report();

}  // namespace tact
