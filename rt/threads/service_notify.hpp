// Reports the controller to the service manager (systemd) over NOTIFY_SOCKET. Without that variable nothing happens.
//
// READY=1     once the servo's heartbeat has advanced
// WATCHDOG=1  a quarter of WATCHDOG_USEC apart, only while the servo's heartbeat advances: a servo that stands still is
//             a service that gets restarted, even where all other threads are alive
// STATUS=     state and rate, once a second where they changed
// STOPPING=1  once, when the run is about to end
// Runs on     the housekeeping thread, and never waits: a datagram that the service manager has no room for is dropped.
//             libsystemd's sd_notify() waits for room (seen with a manager that does not read), and brings six more
//             libraries into the locked memory of this process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact {

// When to feed the watchdog. A pure function of what it is given, for tests.
class WatchdogFeed {
public:
    // limit: of the service manager; zero: it has no watchdog.
    explicit WatchdogFeed(Duration limit) noexcept : every_(limit / 4) {}

    // True: feed it now. heartbeat: any number that changes with each servo cycle.
    bool due(std::int64_t heartbeat, Instant now) noexcept;

private:
    Duration every_;
    std::optional<std::int64_t> heartbeat_;  // at the last feed
    Instant fed_at_{};
};

struct ServiceState {
    std::int64_t heartbeat = 0;
    const char* state = "";  // of the run: "active"
    double rate_hz = 0.0;
};

class ServiceNotify {
public:
    ServiceNotify();
    ~ServiceNotify();
    ServiceNotify(const ServiceNotify&) = delete;
    ServiceNotify& operator=(const ServiceNotify&) = delete;

    void update(const ServiceState& now_is, Instant now);
    void stopping();

private:
    void send(const std::string& lines) const;

    int fd_ = -1;  // -1: no service manager
    WatchdogFeed feed_;
    std::optional<std::int64_t> first_heartbeat_;
    bool ready_ = false, stopping_ = false;
    std::string status_;
    Instant status_at_{};
};

}  // namespace tact
