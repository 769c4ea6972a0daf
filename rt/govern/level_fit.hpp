// The level of a haptic path: of the levels whose predicted cost fits the period, the one with the least error.
//
// Rows        candidate levels with the cost and error that the model predicts. The cost is measured again for each row in the
//             dry cycles (calibrate), so the first armed cycle already has its level.
// Cost        of a whole step, never the truncated one: a step cut by its deadline counts as cost / work_done. While running,
//             three figures correct the prediction:
//               speed      median of measured / predicted cost, followed within a tenth of a second
//               spread     p99.9 of measured / (speed x predicted), over some thousands of cycles
//               interrupts p99.9 of the excess of steps above kInterrupted times their usual cost. No level shortens an
//                          interrupt, so it is added, not multiplied, and takes at most kInterruptShare of the budget
// Fits        speed x spread x predicted + interrupts + rest of the cycle <= kUse x period. A row comes into question for a rise
//             only below kRise of that, so the level does not hunt.
// Deadline    a miss lowers the level at once. A step that was interrupted does not, unless misses come close together: the
//             cheapest level would have missed as well
// Holds       the level rises kHold_s after a fall; a fall soon after a rise doubles that, up to kHoldMost_s
// Thread      servo; constant time, no allocation
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/base/knob.hpp"
#include "ipc/base/rt.hpp"
#include "rt/govern/cost_spread.hpp"

namespace tact {

class LevelFit {
public:
    static constexpr std::size_t kRowsMax = 33;
    static constexpr double kUse = 0.7, kRise = 0.9;
    static constexpr double kInterruptShare = 0.3;
    static constexpr double kHold_s = 0.5, kHoldMost_s = 8.0, kHoldForgotten_s = 10.0;
    static constexpr double kSpeedLeast =
        0.7;  // of the calibrated cost: a step in free space is no measure of one in contact
    static constexpr std::uint32_t kTries = 3;    // dry steps for each row
    static constexpr double kMissRetreat = 0.85;  // of the present cost, after a miss

    struct Row {
        float level = 1.0F;
        double cost_s = 0.0, error = 0.0;
    };
    // One cycle. recomputed: part of the work that was not taken from earlier steps.
    struct Sample {
        float level = 1.0F;
        double model_s = 0.0;
        double work_done = 1.0, recomputed = 1.0;
        double rest_s = 0.0;  // of the cycle before: all but the model
        double dt_s = 0.0;
        bool deadline_missed = false;
    };
    struct Limits {
        double period_s = 1e-3;
        double budget = 1.0;     // of kUse of the period, for a loop that shares its processor
        float level_max = 1.0F;  // the slow update of the model keeps up to here
    };

    // Levels rise from row to row. More than kRowsMax, or none: the last ones are left out; false where nothing is left.
    bool set_rows(std::span<const Row> rows) noexcept TACT_RT;
    [[nodiscard]] std::span<const Row> rows() const noexcept { return {rows_.data(), count_}; }

    // Dry cycles: the level to try next; false when every row was tried.
    [[nodiscard]] bool calibrating(float& level) const noexcept TACT_RT;
    void calibrate(double model_s, double rest_s) noexcept TACT_RT;
    // The best row that fits, without regard to the present one.
    float choose(const Limits& limits) noexcept TACT_RT;

    // Once a cycle. The level from now on, and whether and why it changed.
    struct Choice {
        float level = 1.0F;
        bool changed = false;
        LevelReason reason = LevelReason::start;
    };
    Choice add(const Sample& sample, const Limits& limits) noexcept TACT_RT;
    // Learns from a cycle at a level that somebody else chose.
    CostSpread::Kind learn(const Sample& sample) noexcept TACT_RT;

    [[nodiscard]] double predicted_s(std::size_t row) const noexcept TACT_RT;  // p99.9 of the model's step
    [[nodiscard]] std::size_t row() const noexcept TACT_RT { return row_; }

private:
    [[nodiscard]] double cost_at(float level) const noexcept;
    [[nodiscard]] bool fits(std::size_t row, const Limits& limits, double part) const noexcept;
    [[nodiscard]] std::size_t best(const Limits& limits, double part, double cost_s_most) const noexcept;
    void follow_rest(double rest_s) noexcept;

    std::array<Row, kRowsMax> rows_{};
    std::array<double, kRowsMax> tried_s_{};  // least cost of the tries of a row
    std::size_t count_ = 0, row_ = 0;
    std::uint32_t tries_ = 0;
    CostSpread spread_;
    double rest_s_ = 0.0;  // p99 of the rest of a cycle
    double since_fall_s_ = 1e9, hold_s_ = kHold_s;
    bool rose_ = false;    // since the last fall
    double misses_ = 0.0;  // lately
    std::uint32_t cycle_ = 0;
};

}  // namespace tact
