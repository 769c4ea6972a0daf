// The one table of head trackers. Names are those of tracker.driver in the configuration.
//
// Errors   make_tracker: StartupError, naming the trackers there are
// Thread   start-up
#pragma once

#include <memory>
#include <span>
#include <string>

#include "hal/sim/sim_tracker.hpp"

namespace tact {

struct TrackerSettings {
    std::string driver = "none";
    std::string interface = "can0";
    SimHeadSettings sim;  // its part `can` is what every driver on a bus takes
};

struct TrackerEntry {
    const char* name;
    const char* what;  // for people
    std::unique_ptr<Tracker> (*make)(const TrackerSettings&);
};

[[nodiscard]] std::span<const TrackerEntry> tracker_drivers();
[[nodiscard]] std::unique_ptr<Tracker> make_tracker(const TrackerSettings& settings);  // null: "none"

}  // namespace tact
