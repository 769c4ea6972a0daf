// An emulated head tracker on a CAN interface: SimHeadBus's frames through a raw socket.
//
// Flood    at most what a bus of 1 Mbit/s carries: kFloodBatch frames every kFloodEvery
// Link     down and up are the interface's own, as `ip link set` does; frames that it does not take are
//          counted; an interface that vanished is looked for twice a second
// Thread   one of its own; the public functions on another
// Fails by StartupError naming the interface and the fix
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "hal/sim/sim_head_bus.hpp"
#include "ipc/base/servo_clock.hpp"
#include "tests/emu/report.hpp"
#include "tests/emu/script.hpp"

namespace tact::emu {

class CanHead {
public:
    static constexpr Duration kFloodEvery = std::chrono::milliseconds(4);
    static constexpr std::size_t kFloodBatch = 32;

    CanHead(const SimHeadSettings& settings, std::string interface, Report& report);
    ~CanHead();
    CanHead(const CanHead&) = delete;
    CanHead& operator=(const CanHead&) = delete;

    void start();
    bool apply(const Order& order);  // true: it was for a tracker; StartupError: the link cannot be set
    void say_status();

private:
    void live() noexcept;
    void send(const CanFrame& frame) noexcept;
    void reopen() noexcept;
    void set_link(bool up);
    void say(const char* what, const char* detail) noexcept;

    std::string interface_;
    Report& report_;
    ServoClock clock_{Duration{0}};
    SimHeadBus bus_;
    int fd_ = -1;  // of the thread once it runs
    Instant retry_at_{};
    std::atomic<bool> leave_{false}, flood_{false};
    std::atomic<std::uint64_t> sent_{0}, not_taken_{0};
    std::thread thread_;
};

}  // namespace tact::emu
