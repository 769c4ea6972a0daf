#include "gui/dashboard/trace_trigger.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kAutomaticLeast_s = 0.5;
std::int64_t in_ns(double s) { return static_cast<std::int64_t>(std::llround(1e9 * s)); }

}  // namespace

void TraceTrigger::arm(const TriggerSettings& settings) {
    settings_ = settings;
    settings_.span_s = std::isfinite(settings.span_s) ? std::clamp(settings.span_s, 1e-4, 3600.0) : 1.0;
    settings_.pre_share = std::isfinite(settings.pre_share) ? std::clamp(settings.pre_share, 0.0, 1.0) : 0.5;
    have_before_ = false;
    wait_anew(0);
}

void TraceTrigger::wait_anew(std::int64_t from_ns) {
    state_ = State::waiting;
    waits_since_ns_ = from_ns;
}

bool TraceTrigger::fires(const TriggerSettings& s, const TraceTopic& before, const TraceTopic& now,
                         std::int64_t period_ns) {
    switch (s.source) {
        case TriggerSource::overrun:
            return trace_overran(now, period_ns);
        case TriggerSource::fault:
            return trace_faulted(now) && !trace_faulted(before);
        case TriggerSource::channel:
            break;
    }
    const auto a = static_cast<double>(trace_value(before, s.channel));
    const auto b = static_cast<double>(trace_value(now, s.channel));
    return s.rising ? a < s.level && b >= s.level : a > s.level && b <= s.level;
}

bool TraceTrigger::add(const TraceTopic& cycle, std::int64_t period_ns) {
    if (state_ == State::idle || state_ == State::done) return false;
    const std::int64_t now_ns = cycle.taken_at_ns;
    if (waits_since_ns_ == 0) waits_since_ns_ = now_ns;
    if (state_ == State::waiting) {
        if (have_before_ && fires(settings_, before_, cycle, period_ns)) {
            const std::int64_t span_ns = in_ns(settings_.span_s);
            const std::int64_t begin_ns = now_ns - in_ns(settings_.pre_share * settings_.span_s);
            capture_ = {now_ns, begin_ns, begin_ns + span_ns, false};
            state_ = State::fired;
        } else if (settings_.mode == TriggerMode::automatic &&
                   now_ns - waits_since_ns_ >= in_ns(std::max(settings_.span_s, kAutomaticLeast_s))) {
            capture_ = {now_ns, now_ns - in_ns(settings_.span_s), now_ns, true};
            state_ = State::fired;
        }
    }
    before_ = cycle;
    have_before_ = true;
    if (state_ != State::fired || now_ns < capture_.end_ns) return false;
    if (settings_.mode == TriggerMode::single) {
        state_ = State::done;
    } else {
        wait_anew(now_ns);
    }
    return true;
}

}  // namespace tact
