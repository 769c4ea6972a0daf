// The view of the traces: running or held, the visible window, and two cursors.
//
// Rolls      shows the newest window; with a trigger set, the newest capture
// Held       keeps the cycles of that moment for inspection, while recording continues beside it
// Memory     two stores, allocated once.  Thread  one
#pragma once

#include <array>
#include <cstdint>

#include "gui/dashboard/trace_store.hpp"
#include "gui/dashboard/trace_trigger.hpp"

namespace tact {

enum class TraceRun : std::uint8_t { roll, automatic, normal, single };

class TraceScope {
public:
    static constexpr double kLeastSpan_s = 1e-3, kMostSpan_s = 120.0;

    // Cycles of the controller, in order.
    void add(const TraceTopic& cycle, std::int64_t period_ns);
    void add_missed(std::uint64_t cycles) { missed_ += cycles; }
    void clear();  // for another controller

    void choose_run(TraceRun run);  // takes effect at once
    [[nodiscard]] TraceRun run() const { return run_; }
    void set_trigger(const TriggerSettings& settings);  // the scope sets mode and span
    [[nodiscard]] const TriggerSettings& trigger() const { return wanted_; }
    void hold();
    void go_on();
    [[nodiscard]] bool held() const { return held_; }

    // Duration of the visible window; while running, it ends with the newest cycle.
    void set_span(double span_s);
    [[nodiscard]] double span_s() const { return span_s_; }
    // Zooms about an instant, which keeps its place. times < 1 zooms in.
    void zoom(double times, std::int64_t about_ns);
    // Moves the visible window; a running trace is held first.
    void pan(double by_s);

    [[nodiscard]] const TraceStore& shown() const { return shows_still() ? still_ : live_; }
    [[nodiscard]] const TraceStore& live() const { return live_; }
    [[nodiscard]] std::int64_t begin_ns() const { return end_ns() - span_ns(); }
    [[nodiscard]] std::int64_t end_ns() const;
    // Trigger time of the visible capture, or 0.
    [[nodiscard]] std::int64_t triggered_ns() const;
    [[nodiscard]] bool forced() const { return forced_; }
    // State as text.
    [[nodiscard]] const char* status() const;
    [[nodiscard]] std::uint64_t captures() const { return captures_; }
    [[nodiscard]] std::uint64_t missed() const { return missed_; }
    [[nodiscard]] std::uint64_t refused() const { return live_.refused(); }
    [[nodiscard]] std::size_t memory_bytes() const { return live_.memory_bytes() + still_.memory_bytes(); }

    // Cursors, as fractions of the visible window; while it rolls, they keep their pixels.
    bool cursors = false;
    std::array<double, 2> cursor{0.33, 0.67};
    [[nodiscard]] std::int64_t cursor_ns(std::size_t which) const {
        return begin_ns() + static_cast<std::int64_t>(cursor[which] * static_cast<double>(span_ns()));
    }

private:
    [[nodiscard]] std::int64_t span_ns() const { return static_cast<std::int64_t>(1e9 * span_s_); }
    [[nodiscard]] bool shows_still() const { return held_ || (run_ != TraceRun::roll && captures_ > 0); }
    void arm();

    TraceStore live_, still_;
    TraceTrigger trigger_;
    TriggerSettings wanted_;
    TraceRun run_ = TraceRun::roll;
    bool held_ = false, forced_ = false;
    double span_s_ = 1.0;
    std::int64_t still_end_ns_ = 0, triggered_ns_ = 0;
    std::uint64_t captures_ = 0, missed_ = 0;
};

}  // namespace tact
