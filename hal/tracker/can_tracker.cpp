#include "hal/tracker/can_tracker.hpp"

#include <utility>

#include "hal/tracker/socket_can.hpp"

namespace tact {

CanTracker::CanTracker(const CanTrackerSettings& settings, const std::string& interface)
    : CanTracker(settings, std::make_unique<SocketCan>(interface, settings.fix), interface) {}

CanTracker::CanTracker(const CanTrackerSettings& settings, std::unique_ptr<CanSource> source,
                       const std::string& name)
    : ThreadedTracker(settings, std::move(source),
                      {.name = "tracker on " + name,
                       .sensors = settings.fix.sensors,
                       .rate_hz = settings.rate_hz,
                       .latency = settings.latency},
                      "can") {}

}  // namespace tact
