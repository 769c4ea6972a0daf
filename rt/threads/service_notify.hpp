// Reports the controller's state to the service manager (systemd) over NOTIFY_SOCKET. Does nothing without that variable.
//
// READY=1     once the servo's heartbeat has advanced
// WATCHDOG=1  every quarter of WATCHDOG_USEC, only while the servo's heartbeat advances: systemd then restarts a
//             service with a stopped servo even if all other threads run
// STATUS=     state and rate, on change, at most once per second
// STOPPING=1  once, when the run is about to end
// Runs on     the housekeeping thread without blocking: a datagram for which the service manager has no room is dropped.
//             libsystemd's sd_notify() waits for room (measured with a manager that does not read), and adds six
//             libraries to the locked memory of this process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact {

// Decides when to feed the watchdog. Deterministic, for tests.
class WatchdogFeed {
public:
    // limit: watchdog timeout of the service manager; zero: none.
    explicit WatchdogFeed(Duration limit) noexcept : every_(limit / 4) {}

    // True: feed the watchdog now. heartbeat: any number that changes with each servo cycle.
    bool due(std::int64_t heartbeat, Instant now) noexcept;

private:
    Duration every_;
    std::optional<std::int64_t> heartbeat_;  // at the last feed
    Instant fed_at_{};
};

struct ServiceState {
    std::int64_t heartbeat = 0;
    const char* state = "";  // run state, such as "active"
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
