#include "hal/tracker/igtl_tracker.hpp"

#include <utility>

#include "hal/tracker/igtl_socket.hpp"

namespace tact {

IgtlTracker::IgtlTracker(const IgtlTrackerSettings& settings, const std::string& host, int port)
    : IgtlTracker(settings,
                  std::make_unique<IgtlSocket>(
                      host, port, Duration(static_cast<std::int64_t>(1e9 / checked(settings).rate_hz))),
                  host + ":" + std::to_string(port)) {}

IgtlTracker::IgtlTracker(const IgtlTrackerSettings& settings, std::unique_ptr<IgtlSource> source,
                         const std::string& name)
    : ThreadedTracker(settings, std::move(source),
                      {.name = "OpenIGTLink tracker at " + name,
                       .sensors = static_cast<unsigned>(settings.names.size()),
                       .rate_hz = settings.rate_hz,
                       .latency = settings.latency},
                      "igtl") {}

}  // namespace tact
