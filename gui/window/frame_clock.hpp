// Times the parts of a frame and paces frames. Wall-clock time between calls, without glFinish(), so that measuring
// costs nothing. Late frames are defined in ipc/topics/frames.hpp.
#pragma once

#include <array>
#include <deque>

#include "ipc/base/clock.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/recent_times.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/load.hpp"

namespace tact {

class FrameClock {
public:
    // Starts a frame. due_s: the period in which it is due; 0: none.
    void begin(double due_s);
    void end_part(FramePart part);  // since the last call of either
    // Sleeps until 1/fps_max after the start of this frame. 0: no sleep.
    void pace(double fps_max) const;

    [[nodiscard]] double frame_s() const { return frame_s_; }  // start to start, last frame
    [[nodiscard]] double work_s() const;                       // sum of the parts, this frame
    [[nodiscard]] double part_s(FramePart part) const { return part_s_[static_cast<std::size_t>(part)]; }
    [[nodiscard]] double fps() const { return fps_; }  // over the last second
    [[nodiscard]] std::uint64_t frame() const { return frame_; }
    [[nodiscard]] Instant started_at() const { return started_; }

    void fill(FrameMetrics& metrics) const;

    [[nodiscard]] static double process_cpu_s();

private:
    Instant started_{}, mark_{};
    double frame_s_ = 0.0, fps_ = 0.0;
    std::array<double, static_cast<std::size_t>(FramePart::count)> part_s_{};
    std::uint64_t frame_ = 0;
    std::deque<Instant> recent_;
    double due_s_ = 0.0;
    std::uint64_t late_ = 0;
    RecentTimes window_{600};
    DurationHistogram run_;
};

}  // namespace tact
