// Chooses the level of a haptic path: the smallest error among the levels whose predicted cost fits the period. Of those
// within kSmallLoss of it the cheapest, since time that buys no accuracy only makes misses more likely; at equal costs the
// highest.
//
// Rows        candidate levels with the cost and error that the model predicts. Dry cycles measure the cost of each
//             row (calibrate), so the first armed cycle already has its level. A model may predict more in contact:
//             rows are renewed in turn and keep their largest cost and error of the last kKept_s to 2 kKept_s, unfaded,
//             so strokes that come again do not move the level. What a model only foresees of a contact counts as long as
//             it does: then the contact shows its own cost. If the present row's cost or error leaps, all are renewed;
//             a level whose cost leapt falls at once if it does not fit
// Cost        the cost of a whole step: a step that was cut by its deadline counts as cost / work_done. Four
//             statistics correct the prediction while the loop runs:
//               speed      median of measured / predicted cost of the steps whose predicted cost is at least kTelling
//                          of their row's: cheap steps in free space tell nothing of steps in contact. Follows
//                          within 0.1 s. At a fixed rate another row must fit at the slowest speed of the last kKept_s to
//                          2 kKept_s too: p99.9 is a matter of seconds, and a processor that was slow for a tenth of one
//                          will be again. In a freely running loop a speed above that before the start counts after kKept_s
//               slowest    of measured / predicted, the quantile that one step in 2000 of the last kKept_s to 2 kKept_s
//                          exceeds. Single slow steps and slow seconds are in the same tail: a processor that is slow
//                          in both ways is not slow twice. A row keeps its largest prediction: where a share `near` of
//                          the steps is predicted to cost kNear of that, one in 2000 x near of these may exceed it, and
//                          the rest is below. A newly chosen row that no steps like that have measured fits at least
//                          kSpreadLeast times the speed: a rise because the tail turned out smaller would only be late
//               spread     the same of measured / (speed x predicted), for freely running loops: other programs hold
//                          their core for a while, and that is over when the speed is back
//               interrupts the quantile of the excess of steps that cost more than kInterrupted times the usual.
//                          A level does not change the length of an interrupt, so the excess is added, not
//                          multiplied, and takes at most kInterruptShare of the budget. Interrupts that even the
//                          lowest row could not bear count for nothing: they are missed at any level
// Fits        max(slowest x predicted, speed x predicted + interrupts) + rest of the cycle <= kUse x period:
//             one step in a thousand exceeds it, because an interrupt seldom hits a step that is slow by itself. A
//             freely running loop has no cycle to miss: speed x spread x predicted is held below the deadline, and speed x
//             kFreeSpread x predicted + rest below kUse x period. The
//             present row may use all of that, and falls after it exceeded that for kOver_s; a newly chosen row may
//             use only kRise of it, so the level does not hunt. The first one, which hunts nothing, may use kFirst, if
//             its own dry steps and kTailKnown others were alike: a tail within kAlike of their speed
// None fits   the smallest error among the lowest level and those that cost next to nothing more: a level that saves
//             nothing is not worth its error
// Deadline    about one miss in a thousand cycles is what the quantile permits; the third within as many lowers the
//             level at once, to at most kMissRetreat of the present cost. An interrupted step counts less, since it
//             would have missed at any level. The second miss in a row, of interrupted steps the third, lowers it to what
//             would have fitted; in a freely running loop, whose core other programs hold for several steps, the fourth
// Slower      a run of slow steps, after which the present row no longer fits, lowers the level at once if they take more than
//             kUrgent of the budget, otherwise after kOver_s: cheap steps miss nothing meanwhile
// Holds       the level rises kHold_s after a fall at the earliest, and only if that takes kWorthGain off its error, above the
//             first choice in the first kEarly_s kWorthGainEarly: it settles at once unless that would cost much; a fall after a rise doubles the hold, up to
//             kHoldMost_s. A fall more than kHoldForgotten_s after the previous one restores kHold_s
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
    static constexpr double kUse = 0.7, kRise = 0.88, kFirst = 0.96;
    static constexpr double kInterruptShare = 0.3;
    static constexpr double kHold_s = 0.5, kHoldMost_s = 8.0, kHoldForgotten_s = 10.0;
    // Lower bound of the speed: steps in free space are cheaper than steps in contact.
    static constexpr double kSpeedLeast = 0.7;
    static constexpr std::uint32_t kTries = 3;  // dry steps per row
    static constexpr double kOver_s = 0.1;
    static constexpr double kUrgent = 0.6;  // of the budget, of a step that ends a run of slow ones
    static constexpr double kKept_s = 5.0;
    static constexpr double kTelling = 0.5;
    static constexpr double kLeapt = 1.1;
    static constexpr double kSpreadLeast = 1.16;
    static constexpr double kTailKnown = 300.0, kAlike = 1.1;  // steps; their tail over their speed
    static constexpr double kNear = 0.9, kNearLeast = 0.05, kNearStep = 1e-3;  // of the share of costly steps
    static constexpr double kWorthGain = 0.15, kWorthGainEarly = 0.5, kEarly_s = 10.0;
    static constexpr double kFreeSpread = 1.1;
    static constexpr double kSmallLoss = 0.05;     // of the error
    static constexpr double kSavesNothing = 0.05;  // of the cost
    static constexpr double kMissRetreat = 0.85;   // cost limit after a miss, relative to the present cost

    struct Row {
        float level = 1.0F;
        double cost_s = 0.0, error = 0.0;
    };
    // One cycle. recomputed: fraction of the work that was not reused from earlier steps.
    struct Sample {
        float level = 1.0F;
        double model_s = 0.0;
        double predicted_s = 0.0;  // by the model for this step; 0: that of its row
        double work_done = 1.0, recomputed = 1.0;
        double rest_s = 0.0;  // cost of the previous cycle without the models
        double dt_s = 0.0;
        bool deadline_missed = false;
    };
    struct Limits {
        double period_s = 1e-3;
        double deadline_s = 1e9;    // of the model's step
        bool free_running = false;  // the period is that of the goal, which the mean must keep
        double budget = 1.0;        // times kUse of the period; below 1 for a loop that shares its processor
        float level_max = 1.0F;     // highest level at which the model's slow update keeps its period
    };

    // Levels must rise from row to row. Ignores impossible rows and those beyond kRowsMax. False: no row is left.
    bool set_rows(std::span<const Row> rows) noexcept TACT_RT;
    [[nodiscard]] std::span<const Row> rows() const noexcept { return {rows_.data(), count_}; }

    // Dry cycles: the level to measure next; false when every row has been measured.
    [[nodiscard]] bool calibrating(float& level) const noexcept TACT_RT;
    void calibrate(double model_s, double rest_s) noexcept TACT_RT;
    // Once a cycle, before rows are renewed: predictions age.
    void pass(double dt_s) noexcept TACT_RT;
    // The model's present prediction for a row, and what it foresees of a contact that may come (0: nothing). True: cost
    // or error leapt, so all rows must be renewed before they are compared.
    bool renew(std::size_t row, double cost_s, double error, double foreseen_s = 0.0) noexcept TACT_RT;
    // The row to renew in this cycle: each in turn.
    [[nodiscard]] std::size_t due() const noexcept TACT_RT { return count_ > 0 ? cycle_ % count_ : 0; }
    // Selects the best row that fits, whatever the present row.
    float choose(const Limits& limits) noexcept TACT_RT;

    // Call once a cycle. Returns the new level, whether it changed, and why.
    struct Choice {
        float level = 1.0F;
        bool changed = false;
        LevelReason reason = LevelReason::start;
    };
    Choice add(const Sample& sample, const Limits& limits) noexcept TACT_RT;
    // Updates the statistics without choosing a level (the law "fixed").
    CostSpread::Kind learn(const Sample& sample) noexcept TACT_RT;

    [[nodiscard]] std::size_t row() const noexcept TACT_RT { return row_; }

private:
    // Of a value of each row, between rows in proportion.
    template <class ValueOf>
    [[nodiscard]] double at(float level, ValueOf value_of) const noexcept;
    // Of the steps of any row: see "slowest", "spread" and "interrupts". Read once for all rows of a choice.
    struct Tail {
        double ratio = 1.0, interrupt_s = 0.0;
        bool alike = false;
    };
    [[nodiscard]] Tail read_tail(const Limits& limits) const noexcept;
    [[nodiscard]] bool fits(std::size_t row, const Limits& limits, const Tail& tail,
                            double part) const noexcept;
    [[nodiscard]] std::size_t best(const Limits& limits, double part, double cost_s_most) const noexcept;
    void follow_rest(double rest_s) noexcept;
    // Largest cost of a row that counts now.
    [[nodiscard]] double cost_s(std::size_t row) const noexcept;

    std::array<Row, kRowsMax> rows_{};
    std::array<double, kRowsMax> tried_s_{};  // smallest cost measured per row; 0: none
    // Largest predictions of the present window of kKept_s.
    struct Window {
        double cost_s = 0.0, error = 0.0, cost_before_s = 0.0, error_before = 0.0;
        double foreseen_s = 0.0;
        bool renewed = false;
    };
    std::array<Window, kRowsMax> window_{};
    double window_age_s_ = 0.0;
    double slow_ = 0.0, slow_before_ = 0.0;  // largest spread_.speed() of the present and the last window
    std::size_t count_ = 0, row_ = 0, first_row_ = 0;
    double since_choice_s_ = 0.0;
    std::uint32_t tries_ = 0;
    CostSpread spread_;
    double near_ = 1.0;    // share of the steps that are predicted to cost as much as their row, or nearly
    double rest_s_ = 0.0;  // p99 cost of the rest of a cycle
    double since_fall_s_ = 1e9, hold_s_ = kHold_s;
    bool rose_ = false;    // the level rose since the last fall
    double over_s_ = 0.0;  // time for which the present row has not fitted
    double misses_ = 0.0;  // decaying count
    std::uint32_t misses_in_a_row_ = 0;
    bool leapt_ = false;  // the predicted cost of the present row, since the last choice
    std::uint32_t cycle_ = 0;
};

}  // namespace tact
