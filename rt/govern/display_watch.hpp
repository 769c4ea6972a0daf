// Which words of the visual process may be believed: those of frames that applied the levels as they stand.
//
// asked()    a visual level has changed with this sequence of the levels
// pending()  no frame has applied yet, and it has not been silent about it for kAnswerMax_s: what is measured
//            meanwhile says nothing about the levels that stand
// take()     once for each frame that applied. Words in between were not seen, so costs are a mean over them;
// of
//            several frames of which the first did not apply yet, they are the costs of no level and left out
// Hostile    any numbers; the governor judges times, this judges order
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "ipc/base/rt.hpp"
#include "rt/govern/governor.hpp"

namespace tact {

struct PictureWord {
    std::uint64_t frame = 0;
    std::uint64_t levels_sequence = 0;  // of the levels that this frame applied
    std::int64_t taken_at_ns = 0;
    double work_s = 0.0;  // of the frame, without its pause
    double cpu_s = 0.0;   // processor time of the visual process since its start
    bool drawn = false;   // there was something to draw
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
    [[nodiscard]] std::optional<DisplaySample> take(const PictureWord& w) noexcept TACT_RT {
        if (w.frame == last_.frame) return std::nullopt;
        const bool first = w.frame < last_.frame || last_.frame == 0;  // of this visual process
        const bool applied_before = applied_;
        const double frames = first ? 1.0 : static_cast<double>(w.frame - last_.frame);
        const DisplaySample look{.work_s = w.work_s,
                                 .processor_s = std::max(w.cpu_s - last_.cpu_s, 0.0) / frames,
                                 .period_s = std::max(1e-9 * (static_cast<double>(w.taken_at_ns) -
                                                              static_cast<double>(last_.taken_at_ns)),
                                                      0.0) /
                                             frames};
        last_ = w;
        applied_ = w.levels_sequence >= from_;
        if (first || !applied_ || !w.drawn) return std::nullopt;
        if (!applied_before && frames > 1.0) return std::nullopt;
        return look;
    }

private:
    PictureWord last_{};
    std::uint64_t from_ = 0;
    Instant asked_at_{};
    bool applied_ = true;
};

}  // namespace tact
