// The head tracker on a CAN bus: a CanReader on its own thread, "can".
#pragma once

#include <memory>
#include <string>

#include "hal/tracker/can_reader.hpp"
#include "hal/tracker/threaded_tracker.hpp"

namespace tact {

class CanTracker final : public ThreadedTracker<CanTrackerSettings, CanSource, CanReader> {
public:
    CanTracker(const CanTrackerSettings& settings, const std::string& interface);
    // With any source of frames; `name` is for people.
    CanTracker(const CanTrackerSettings& settings, std::unique_ptr<CanSource> source,
               const std::string& name);
};

}  // namespace tact
