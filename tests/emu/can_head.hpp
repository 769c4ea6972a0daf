// An emulated head tracker on a CAN interface: sends SimHeadBus's frames through a raw socket.
//
// Flood    at most the load of a bus of 1 Mbit/s: kFloodBatch frames every kFloodEvery
// Link     down and up act on the interface, as `ip link set` does; frames that the interface refuses are counted;
//          a vanished interface is searched for twice per second
// Thread   one of its own; the public functions on another
// Fails by StartupError with the interface and the fix
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
    bool apply(
        const Order& order);  // true: the order was for a tracker; StartupError: the link cannot be set
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
    int fd_ = -1;  // owned by the thread once it runs
    Instant retry_at_{};
    std::atomic<bool> leave_{false}, flood_{false};
    std::atomic<std::uint64_t> sent_{0}, not_taken_{0};
    std::thread thread_;
};

}  // namespace tact::emu
