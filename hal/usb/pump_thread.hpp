// The thread of a pump: runs rounds until stop(), then until the last command sent switches the motors off.
//
// Thread  start() and stop() on the main one
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "hal/usb/bus.hpp"

namespace tact::usb {

class PumpThread {
public:
    static constexpr Duration kFlushMax = std::chrono::milliseconds(50);

    PumpThread() = default;
    ~PumpThread() { stop(); }
    PumpThread(const PumpThread&) = delete;
    PumpThread& operator=(const PumpThread&) = delete;

    // `name`: of the thread, at most 15 characters. `what` names it in a message: "the arm's USB". FIFO
    // priority; 0: ordinary scheduling. Returns the reason if it runs without that priority. Pump and bus
    // must outlive stop().
    template <class Pump>
    [[nodiscard]] std::string start(Pump& pump, Bus& bus, const char* name, const char* what, int priority) {
        return start([this, &pump, &bus] { run(pump, bus); }, name, what, priority);
    }
    void stop() noexcept;

private:
    template <class Pump>
    void run(Pump& pump, Bus& bus) noexcept {
        while (!leave_.load(std::memory_order_relaxed)) pump.round(pump.patience());
        const Instant end = bus.now() + kFlushMax;
        while (!pump.quiet() && bus.now() < end) pump.round(std::chrono::milliseconds(1));
    }
    [[nodiscard]] std::string start(std::function<void()> run, const char* name, const char* what,
                                    int priority);

    std::thread thread_;
    std::atomic<bool> leave_{false};
};

}  // namespace tact::usb
