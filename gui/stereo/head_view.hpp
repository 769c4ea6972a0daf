// Where the head is when the picture is seen: the tracked head moved on at its speed, and held softly when it is lost.
//
// Fresh     moved on to the time of display, at most 50 ms past its measurement.
// Lost      stands where it was seen last; so does the view. Back again, it glides there within some tenths of a second
//           instead of leaping.
// None      without a tracker the head stands where `rest` says.
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
    static constexpr double kSmoothS = 0.12;  // after which a third of the way is left

    explicit HeadView(const Pose& rest) : shown_(rest), aim_(rest) {}
    // head: null without a controller; times of the monotonic clock. The picture is seen at display_ns.
    const Pose& follow(const HeadTopic* head, std::int64_t now_ns, std::int64_t display_ns);
    [[nodiscard]] const Pose& pose() const { return shown_; }
    [[nodiscard]] HeadSight sight() const { return sight_; }

private:
    Pose shown_, aim_;
    Pose off_;  // what is left of a leap: shown = off * aim
    HeadSight sight_ = HeadSight::none;
    std::int64_t now_ns_ = 0;
};

}  // namespace tact
