// Trigger for captures of servo cycles, evaluated per cycle as in an oscilloscope.
//
// Single     one capture, then done until armed again
// Normal     a capture at each trigger, but not before the end of the last one
// Automatic  as normal, plus a forced capture if no trigger came for one span, at least half a second
// Thread     one; plain arithmetic. NaN triggers nothing
#pragma once

#include <cstdint>

#include "gui/dashboard/trace_store.hpp"

namespace tact {

enum class TriggerSource : std::uint8_t { channel, overrun, fault };
enum class TriggerMode : std::uint8_t { automatic, normal, single };

struct TriggerSettings {
    TriggerSource source = TriggerSource::channel;
    TraceChannel channel = TraceChannel::force;
    bool rising = true;
    double level = 0.5;  // SI
    TriggerMode mode = TriggerMode::normal;
    double pre_share = 0.5;  // fraction of the span before the trigger, 0 to 1
    double span_s = 1.0;
};

struct TraceCapture {
    std::int64_t trigger_ns = 0, begin_ns = 0, end_ns = 0;
    bool forced = false;  // no trigger occurred
};

class TraceTrigger {
public:
    enum class State : std::uint8_t { idle, waiting, fired, done };

    void arm(const TriggerSettings& settings);
    void disarm() { state_ = State::idle; }
    // Adds the next cycle. Returns true if it completes a capture.
    bool add(const TraceTopic& cycle, std::int64_t period_ns);

    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] const TraceCapture& capture() const { return capture_; }
    [[nodiscard]] const TriggerSettings& settings() const { return settings_; }
    // True if the trigger fires between these two successive cycles.
    [[nodiscard]] static bool fires(const TriggerSettings& settings, const TraceTopic& before,
                                    const TraceTopic& now, std::int64_t period_ns);

private:
    void wait_anew(std::int64_t from_ns);

    TriggerSettings settings_;
    State state_ = State::idle;
    TraceTopic before_{};
    bool have_before_ = false;
    std::int64_t waits_since_ns_ = 0;
    TraceCapture capture_;
};

}  // namespace tact
