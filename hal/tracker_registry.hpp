// Table of the head trackers. The names are the values of tracker.driver in the configuration.
//
// Errors   make_tracker: StartupError, listing the known trackers
// Thread   start-up
#pragma once

#include <memory>
#include <span>
#include <string>

#include "hal/sim/sim_tracker.hpp"
#include "hal/tracker/igtl_reader.hpp"

namespace tact {

struct TrackerSettings {
    std::string driver = "none";
    std::string interface = "can0";
    SimHeadSettings sim;             // its member `can` applies to every CAN driver
    std::string host = "127.0.0.1";  // of an OpenIGTLink server
    int port = kIgtlPort;
    IgtlTrackerSettings igtl{};
};

struct TrackerEntry {
    const char* name;
    const char* what;  // description for people
    std::unique_ptr<Tracker> (*make)(const TrackerSettings&);
};

[[nodiscard]] std::span<const TrackerEntry> tracker_drivers();
[[nodiscard]] std::unique_ptr<Tracker> make_tracker(const TrackerSettings& settings);  // null: "none"

}  // namespace tact
