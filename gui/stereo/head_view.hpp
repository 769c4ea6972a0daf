// Pose of the head at display time: extrapolated at its velocity, and held smoothly when lost.
//
// Fresh     extrapolated to the time of display, at most 50 ms past its measurement.
// Lost      stays at its last position; so does the view. Found again, it glides there within some tenths of a
//           second instead of jumping.
// None      without a tracker the head is at `rest`.
// Frame     screen, see gui/render/screen.hpp.  Thread  one; plain arithmetic.
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/topics/head.hpp"

namespace tact {

enum class HeadSight : std::uint8_t { none, lost, seen };

class HeadView {
public:
    static constexpr std::int64_t kHorizonNs = 50'000'000;
    static constexpr double kSmoothS = 0.12;  // time constant

    explicit HeadView(const Pose& rest) : shown_(rest), aim_(rest) {}
    // head: null without a controller; times on the monotonic clock. The frame is displayed at display_ns.
    const Pose& follow(const HeadTopic* head, std::int64_t now_ns, std::int64_t display_ns);
    [[nodiscard]] const Pose& pose() const { return shown_; }
    [[nodiscard]] HeadSight sight() const { return sight_; }

private:
    Pose shown_, aim_;
    Pose off_;  // remainder of a jump: shown = off * aim
    HeadSight sight_ = HeadSight::none;
    std::int64_t now_ns_ = 0;
};

}  // namespace tact
