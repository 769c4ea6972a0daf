// What each visual path costs in a frame, and by how much a lower level would shorten it.
//
// Model     time of a frame = rest + sum of rate_i * level_i. Least squares over the measured frames, old ones fading. Levels that moved
//           together are told apart as far as the frames allow
// Prior     half of a path's reported cost is in proportion to its level. A path without a report costs nothing; if there is no
//           report at all, the first path costs the whole frame. Levels that never move tell nothing, and then the prior
//           stands; it weighs as much as a spread of the levels by kPriorSpread of themselves
// Gain      seconds per unit of ln(level): cost times elasticity. It lies between kLeastGain of the path's cost (kLeast of an
//           only path's) and all of it, whatever is measured
// Thread    servo; constant time
#pragma once

#include <array>
#include <cstddef>

#include "ipc/base/rt.hpp"

namespace tact {

class DisplayCost {
public:
    static constexpr std::size_t kPathsMax = 8;
    static constexpr double kLeast = 0.05;      // of the elasticity of all paths together, to divide by
    static constexpr double kLeastGain = 0.01;  // of a path's cost, if there are several
    static constexpr double kPriorSpread = 0.1;
    static constexpr double kMemory = 200.0;  // frames
    // By path; 0 where a path is absent.
    using PerPath = std::array<double, kPathsMax>;

    // A frame drawn at these levels. share: of its time, as reported for each path; 0: no report.
    void add(const PerPath& level, const PerPath& share, double frame_s) noexcept TACT_RT;
    struct Estimate {
        double frame_s = 0.0;  // 0: nothing measured
        PerPath gain_s{};
        // d ln(time) / d ln(level) if all levels change by the same factor; a half where nothing is measured.
        [[nodiscard]] double elasticity() const noexcept TACT_RT;
    };
    [[nodiscard]] Estimate at(const PerPath& level) const noexcept TACT_RT;

private:
    [[nodiscard]] PerPath rates() const noexcept TACT_RT;

    double frames_ = 0.0, mean_s_ = 0.0;
    PerPath mean_{}, share_{}, with_time_{};  // with_time_: covariance of each level with the time
    std::array<PerPath, kPathsMax> with_level_{};
};

}  // namespace tact
