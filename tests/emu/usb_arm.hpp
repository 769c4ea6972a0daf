// An emulated arm on the USB bus: EmulatedBoard behind a Gadget.
//
// Threads  four, each waiting in the kernel: the board's clock, states to the host, commands from the host, and the
//          control endpoint. None spins.
// Reports  with a time stamp: plugged, configured, version sent, amplifier, currents
// Thread   the public functions on one
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "tests/emu/board.hpp"
#include "tests/emu/gadget.hpp"
#include "tests/emu/report.hpp"
#include "tests/emu/script.hpp"

namespace tact::emu {

class UsbArm {
public:
    UsbArm(const BoardSettings& settings, Report& report);  // StartupError
    ~UsbArm();
    UsbArm(const UsbArm&) = delete;
    UsbArm& operator=(const UsbArm&) = delete;

    void start();  // starts the threads; not yet plugged
    // True: done. False: not an action of an arm.
    bool apply(const Order& order);
    void say_status();
    [[nodiscard]] const std::string& serial() const noexcept { return serial_; }

private:
    struct Seen {
        phantom::AmplifierState amplifier = phantom::AmplifierState::off;
        bool flowing = false, hand_free = false;
    };
    void live_clock() noexcept;
    void live_to_host() noexcept;
    void live_from_host() noexcept;
    void live_control() noexcept;
    [[nodiscard]] bool is_configured() noexcept;  // waits a while for it
    void configured_is(bool on) noexcept;
    void look(Instant now) noexcept;  // needs mutex_
    void say(const char* what, std::string detail, Instant at) noexcept;
    void fault_of(const Order& order);  // needs mutex_

    std::string serial_;
    Report& report_;
    EmulatedBoard board_;
    Gadget gadget_;
    Duration tick_;
    std::mutex mutex_;  // protects board_ and the fields up to the next blank line
    std::condition_variable fresh_, plugged_in_;
    Seen seen_;
    Instant thaw_at_{};  // end of silence; 0: none
    bool configured_ = false;

    std::atomic<bool> leave_{false}, stall_{false};
    std::atomic<std::uint64_t> states_{0}, commands_{0};
    std::thread clock_, to_host_, from_host_, control_;
};

}  // namespace tact::emu
