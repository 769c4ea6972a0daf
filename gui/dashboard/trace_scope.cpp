#include "gui/dashboard/trace_scope.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

void TraceScope::add(const TraceTopic& cycle, std::int64_t period_ns) {
    if (!live_.add(cycle)) return;
    if (held_ || !trigger_.add(cycle, period_ns)) return;
    const TraceCapture& c = trigger_.capture();
    still_.copy(live_, c.begin_ns, c.end_ns);
    still_end_ns_ = c.end_ns;
    triggered_ns_ = c.forced ? 0 : c.trigger_ns;
    forced_ = c.forced;
    ++captures_;
}

void TraceScope::clear() {
    live_.clear();
    still_.clear();
    captures_ = missed_ = 0;
    triggered_ns_ = 0;
    held_ = false;
    if (run_ != TraceRun::roll) arm();
}

void TraceScope::arm() {
    TriggerSettings s = wanted_;
    s.span_s = span_s_;
    s.mode = run_ == TraceRun::automatic ? TriggerMode::automatic
             : run_ == TraceRun::single  ? TriggerMode::single
                                         : TriggerMode::normal;
    trigger_.arm(s);
}

void TraceScope::choose_run(TraceRun run) {
    run_ = run;
    captures_ = 0;
    triggered_ns_ = 0;
    forced_ = held_ = false;
    if (run == TraceRun::roll) {
        trigger_.disarm();
    } else {
        arm();
    }
}

void TraceScope::set_trigger(const TriggerSettings& settings) {
    wanted_ = settings;
    if (run_ != TraceRun::roll && !held_) choose_run(run_);
}

void TraceScope::hold() {
    if (held_) return;
    if (!shows_still()) {
        still_.copy(live_, live_.begin_ns(), live_.end_ns());
        still_end_ns_ = still_.end_ns();
        triggered_ns_ = 0;
    }
    held_ = true;
}

void TraceScope::go_on() { choose_run(run_); }

void TraceScope::set_span(double span_s) {
    if (!std::isfinite(span_s)) return;
    span_s_ = std::clamp(span_s, kLeastSpan_s, kMostSpan_s);
    if (run_ != TraceRun::roll && !held_) choose_run(run_);
}

void TraceScope::zoom(double times, std::int64_t about_ns) {
    if (!(times > 0.0) || !std::isfinite(times)) return;
    if (!shows_still()) return set_span(span_s_ * times);
    hold();  // an inspected capture stays
    const double before_s = span_s_;
    span_s_ = std::clamp(span_s_ * times, kLeastSpan_s, kMostSpan_s);
    const double after = static_cast<double>(still_end_ns_ - about_ns) * (span_s_ / before_s);
    still_end_ns_ = about_ns + static_cast<std::int64_t>(after);
}

void TraceScope::pan(double by_s) {
    if (!std::isfinite(by_s)) return;
    hold();
    // Some of the stored cycles stay visible.
    const std::int64_t tenth = span_ns() / 10;
    const std::int64_t least = still_.begin_ns() + tenth, most = still_.end_ns() + span_ns() - tenth;
    still_end_ns_ =
        std::clamp(still_end_ns_ + static_cast<std::int64_t>(1e9 * by_s), least, std::max(least, most));
}

std::int64_t TraceScope::end_ns() const { return shows_still() ? still_end_ns_ : live_.end_ns(); }

std::int64_t TraceScope::triggered_ns() const { return shows_still() ? triggered_ns_ : 0; }

const char* TraceScope::status() const {
    if (held_) return "paused";
    if (run_ == TraceRun::roll) return live_.empty() ? "no cycle yet" : "running";
    switch (trigger_.state()) {
        case TraceTrigger::State::waiting:
            return run_ == TraceRun::automatic && forced_ ? "no trigger, shown anyway"
                                                          : "waiting for the trigger";
        case TraceTrigger::State::fired:
            return "triggered";
        case TraceTrigger::State::done:
            return "captured";
        case TraceTrigger::State::idle:
            break;
    }
    return "stopped";
}

}  // namespace tact
