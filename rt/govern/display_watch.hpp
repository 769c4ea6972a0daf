// Selects the frame reports of the visual process that measure the present visual levels.
//
// asked()    records that a visual level changed with this sequence number
// pending()  true until a frame has applied the change, for at most kAnswerMax_s; measurements taken meanwhile do
//            not describe the present levels
// take()     returns one sample per frame that applied them. Reports can be skipped, so costs are means over the
//            skipped frames; a mean that includes frames from before the change is dropped
// Hostile    accepts any numbers: this class checks the order of reports, the governor checks the times
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "ipc/base/rt.hpp"
#include "rt/govern/governor.hpp"

namespace tact {

struct DisplayReport {
    std::uint64_t frame = 0;
    std::uint64_t levels_sequence = 0;  // sequence of the levels that this frame applied
    std::int64_t taken_at_ns = 0;
    double work_s = 0.0;   // time to draw the frame, without the pause after it
    double cpu_s = 0.0;    // processor time of the visual process since it started
    bool drawn = false;    // the frame had something to draw
    bool refined = false;  // not drawn at the levels: a resting view in full detail, or a measurement
};

class DisplayWatch {
public:
    static constexpr double kAnswerMax_s = 0.5;

    void asked(std::uint64_t sequence, Instant now) noexcept TACT_RT {
        from_ = sequence;
        asked_at_ = now;
        applied_ = false;
    }
    [[nodiscard]] bool pending(Instant now) const noexcept TACT_RT {
        return !applied_ && to_s(now - asked_at_) < kAnswerMax_s;
    }
    [[nodiscard]] std::optional<DisplaySample> take(const DisplayReport& w) noexcept TACT_RT {
        if (w.frame == last_.frame) return std::nullopt;
        const bool first = w.frame < last_.frame || last_.frame == 0;  // first report of this visual process
        const bool applied_before = applied_;
        const double frames = first ? 1.0 : static_cast<double>(w.frame - last_.frame);
        const DisplaySample look{.work_s = w.work_s,
                                 .processor_s = std::max(w.cpu_s - last_.cpu_s, 0.0) / frames,
                                 .period_s = std::max(1e-9 * (static_cast<double>(w.taken_at_ns) -
                                                              static_cast<double>(last_.taken_at_ns)),
                                                      0.0) /
                                             frames};
        last_ = w;
        if (w.refined) return std::nullopt;
        applied_ = w.levels_sequence >= from_;
        if (first || !applied_ || !w.drawn) return std::nullopt;
        if (!applied_before && frames > 1.0) return std::nullopt;
        return look;
    }

private:
    DisplayReport last_{};
    std::uint64_t from_ = 0;
    Instant asked_at_{};
    bool applied_ = true;
};

}  // namespace tact
