// What the servo thread counts about itself. Constant time per cycle; percentiles once a second.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

// Updates per second over a sliding second, in tenths.
class RateWindow {
public:
    void start(Instant now) noexcept {
        *this = {};
        begun_at_ = slot_at_ = now;
    }
    void count() noexcept TACT_RT {
        ++in_slot_;
        ++total_;
    }
    // A tenth of a second is over.
    void turn(Instant now) noexcept TACT_RT {
        slots_[next_ % kSlots] = {now - slot_at_, in_slot_};
        ++next_;
        slot_at_ = now;
        in_slot_ = 0;
    }
    [[nodiscard]] double rate_hz() const noexcept TACT_RT {
        Duration length{0};
        std::uint64_t updates = 0;
        for (const Slot& s : slots_) {
            length += s.length;
            updates += s.updates;
        }
        return length.count() > 0 ? static_cast<double>(updates) / to_s(length) : 0.0;
    }
    [[nodiscard]] double mean_hz(Instant now) const noexcept TACT_RT {
        return now > begun_at_ ? static_cast<double>(total_) / to_s(now - begun_at_) : 0.0;
    }

private:
    static constexpr std::size_t kSlots = 10;
    struct Slot {
        Duration length{0};
        std::uint64_t updates = 0;
    };
    std::array<Slot, kSlots> slots_{};
    std::size_t next_ = 0;
    Instant begun_at_{}, slot_at_{};
    std::uint64_t in_slot_ = 0, total_ = 0;
};

struct WindowFigures {
    std::int64_t lateness_p50_ns = 0, lateness_p99_ns = 0, lateness_max_ns = 0;
    std::int64_t cost_p50_ns = 0, cost_max_ns = 0;
};

class ServoStatistics {
public:
    void start(Instant now) noexcept {
        *this = {};
        rate.start(now);
        second_at_ = now;
    }
    void late(Duration d) noexcept TACT_RT {
        lateness.add(d);
        window_lateness_.add(d);
    }
    void spent(Duration d) noexcept TACT_RT { window_cost_.add(d); }
    // True once a second, with new figures.
    bool second_over(Instant now) noexcept TACT_RT {
        if (now - second_at_ < std::chrono::seconds(1)) {
            if (!whole_second_) figures = look();
            return false;
        }
        figures = look();
        whole_second_ = true;
        window_lateness_.clear();
        window_cost_.clear();
        second_at_ = now;
        return true;
    }

    RateWindow rate;
    DurationHistogram lateness;  // since start
    WindowFigures figures;       // of the last whole second; before the first, so far

private:
    [[nodiscard]] WindowFigures look() const noexcept {
        const auto ns = [](std::uint64_t v) { return static_cast<std::int64_t>(v); };
        return {ns(window_lateness_.percentile_ns(0.5)), ns(window_lateness_.percentile_ns(0.99)),
                ns(window_lateness_.max_ns()), ns(window_cost_.percentile_ns(0.5)),
                ns(window_cost_.max_ns())};
    }
    DurationHistogram window_lateness_, window_cost_;
    Instant second_at_{};
    bool whole_second_ = false;
};

}  // namespace tact
