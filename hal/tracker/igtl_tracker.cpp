#include "hal/tracker/igtl_tracker.hpp"

#include <pthread.h>
#include <sched.h>

#include <utility>

#include "hal/tracker/igtl_socket.hpp"
#include "ipc/base/quiet_thread.hpp"

namespace tact {

IgtlTracker::IgtlTracker(const IgtlTrackerSettings& settings, const std::string& host, int port)
    : IgtlTracker(settings,
                  std::make_unique<IgtlSocket>(
                      host, port, Duration(static_cast<std::int64_t>(1e9 / checked(settings).rate_hz))),
                  host + ":" + std::to_string(port)) {}

IgtlTracker::IgtlTracker(const IgtlTrackerSettings& settings, std::unique_ptr<IgtlSource> source,
                         std::string name)
    : settings_(settings),
      name_(std::move(name)),
      source_(std::move(source)),
      reader_(settings, *source_, clock_) {}

IgtlTracker::~IgtlTracker() {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

TrackerInfo IgtlTracker::open() {
    if (!thread_.joinable()) {
        source_->open();
        reader_.opened();
        thread_ = start_quiet_thread([this] { live(); });
    }
    TrackerInfo info;
    info.name = "OpenIGTLink tracker at " + name_;
    info.sensors = static_cast<unsigned>(settings_.names.size());
    info.rate_hz = settings_.rate_hz;
    info.latency = settings_.latency;
    return info;
}

void IgtlTracker::live() noexcept {
    pthread_setname_np(pthread_self(), "igtl");
    sched_param param{};
    param.sched_priority = kPriority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);  // without the right: ordinary scheduling
    while (!leave_.load(std::memory_order_relaxed)) reader_.round(std::chrono::milliseconds(10));
}

TrackerState IgtlTracker::read(unsigned sensor, TrackerSample& newest, Instant now) noexcept {
    return reader_.read(sensor, newest, now);
}

TrackerHealth IgtlTracker::health() const noexcept { return reader_.health(); }

}  // namespace tact
