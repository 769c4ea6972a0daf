#include "hal/tracker/can_tracker.hpp"

#include <pthread.h>
#include <sched.h>

#include <utility>

#include "hal/tracker/socket_can.hpp"
#include "ipc/base/quiet_thread.hpp"

namespace tact {

CanTracker::CanTracker(const CanTrackerSettings& settings, const std::string& interface)
    : CanTracker(settings, std::make_unique<SocketCan>(interface, settings.fix), interface) {}

CanTracker::CanTracker(const CanTrackerSettings& settings, std::unique_ptr<CanSource> source,
                       std::string name)
    : settings_(settings),
      name_(std::move(name)),
      source_(std::move(source)),
      reader_(settings, *source_, clock_) {}

CanTracker::~CanTracker() {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

TrackerInfo CanTracker::open() {
    if (!thread_.joinable()) {
        source_->open();
        reader_.opened();
        thread_ = start_quiet_thread([this] { live(); });
    }
    TrackerInfo info;
    info.name = "tracker on " + name_;
    info.sensors = settings_.fix.sensors;
    info.rate_hz = settings_.rate_hz;
    info.latency = settings_.latency;
    return info;
}

void CanTracker::live() noexcept {
    pthread_setname_np(pthread_self(), "can");
    sched_param param{};
    param.sched_priority = kPriority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);  // without the right: ordinary scheduling
    while (!leave_.load(std::memory_order_relaxed)) reader_.round(std::chrono::milliseconds(10));
}

TrackerState CanTracker::read(unsigned sensor, TrackerSample& newest, Instant now) noexcept {
    return reader_.read(sensor, newest, now);
}

TrackerHealth CanTracker::health() const noexcept { return reader_.health(); }

}  // namespace tact
