// Monitors the servo's heartbeat on another thread, and drops the enable line when the heartbeat stops.
//
// Latched  from the drop until a person re-arms; the servo, once it runs again, finds the drop in the pulse and latches
//          the fault
// Thread   "supervisor", FIFO 95 if permitted, off the servo's core if possible; checks once per millisecond. check() is
//          deterministic, for tests.
// Not here the device's own enable: HapticDevice belongs to the servo thread. The device's watchdog detects the same
//          silence.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/base/fifo.hpp"
#include "rt/servo/servo_pulse.hpp"

namespace tact {

class Supervision {
public:
    explicit Supervision(Duration silence_max) noexcept : silence_max_(silence_max) {}

    // True: drop the enable line now.
    bool check(Instant beat, bool enabled, std::uint64_t rearms, Instant now) noexcept;
    [[nodiscard]] bool dropped() const noexcept { return dropped_; }
    [[nodiscard]] std::uint64_t drops() const noexcept { return drops_; }

private:
    Duration silence_max_;
    bool dropped_ = false;
    std::uint64_t drops_ = 0, rearms_ = 0;
};

class Supervisor {
public:
    static constexpr int kPriority = kSupervisorPriority;
    static constexpr Duration kEvery = std::chrono::milliseconds(1);

    // `drop` runs on the supervisor's thread and must not block.
    Supervisor(ServoPulse& pulse, Duration silence_max, std::function<void()> drop);
    ~Supervisor();
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;

    void start(int servo_thread_id);

private:
    ServoPulse& pulse_;
    Supervision supervision_;
    std::function<void()> drop_;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
