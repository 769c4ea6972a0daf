// The one place that turns fidelity knobs.
//
// Runs on   servo thread: step() every so many milliseconds, look() at each frame that applied; constant time
// In        the rate of the force loop, what the picture costs, and which paths are there
// Out       one level per path, within [floor, 1]; whether any changed
// Goals     of the force rate, always; of the picture's own rate, where one is set and somebody draws
// Order     rate too low: visual levels first, all by the same factor; haptic ones only when no visual one
//           can give more. Rate to spare: haptic ones first. Down at once, up no faster than the knob's slew,
//           and visual ones only where the picture has time to spare too
// Wind-up   none: the levels themselves are all that is integrated, and they are clamped
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/knob.hpp"
#include "ipc/base/rt.hpp"
#include "rt/govern/cost_fit.hpp"
#include "rt/govern/law.hpp"
#include "rt/govern/rate_filter.hpp"

namespace tact {

struct GovernorSettings {
    Law law = kDefaultLaw;
    double goal_hz = 1000.0;
    double display_goal_hz = 0.0;  // 0: the picture has no goal of its own
    double gain = 0.5;             // s of the law "sensitus"
    double tolerance = 0.02;       // epsilon of the law "sensitus"
};

struct GovernedPath {
    KnobSpec knob;
    float level = 1.0F;
    float requested = 1.0F;  // by a person, for the law "fixed"
    bool present = true;     // an absent path (no GUI attached) keeps its level and takes no part
    // A fitted path has its level from level_fit.hpp. The laws move its budget, by the factors and in the order of levels.
    bool fitted = false;
    float budget = 1.0F;
    LevelReason reason = LevelReason::start;
};

// A frame that was drawn with the present levels.
struct DisplaySample {
    double work_s = 0.0;       // its time, without the pause that keeps to a highest rate of pictures
    double processor_s = 0.0;  // of the visual process, since the frame before
    double period_s = 0.0;     // since the frame before
};

class Governor {
public:
    static constexpr std::size_t kPathsMax = 8;

    explicit Governor(const GovernorSettings& settings) noexcept;

    // Before the loop starts. The index of the path; kPathsMax where the table is full or the knob
    // impossible.
    std::size_t add(const KnobSpec& knob) noexcept;
    // Another load on the same path, at its start level; what a person set is then gone to by the knob's
    // slew. An impossible knob leaves the old one.
    void replace(std::size_t path, const KnobSpec& knob) noexcept TACT_RT;
    // True: a level or its reason changed. rate_hz of the last interval, dt its length.
    bool step(double rate_hz, Duration dt) noexcept TACT_RT;
    // One frame, once, and only one that applied the levels as they are. True as above.
    bool update(const DisplaySample& picture) noexcept TACT_RT;

    bool set_goal_hz(double goal_hz) noexcept TACT_RT;                // false: not a rate
    bool set_level(std::size_t path, double level) noexcept TACT_RT;  // turns the law to "fixed"
    void set_law(Law law) noexcept TACT_RT;
    // The path becomes a fitted one. True: the level is another than before. The law "fixed" leaves it to the person.
    bool set_fitted_level(std::size_t path, float level, LevelReason reason) noexcept TACT_RT;
    void set_present(std::size_t path, bool present) noexcept TACT_RT;

    [[nodiscard]] std::span<const GovernedPath> paths() const noexcept { return {paths_.data(), count_}; }
    [[nodiscard]] float level(std::size_t path) const noexcept { return paths_[path].level; }
    // A visual path that could be lowered.
    [[nodiscard]] bool visual_can_give() const noexcept;
    [[nodiscard]] const GovernorSettings& settings() const noexcept { return settings_; }

private:
    struct Factors {
        double visual, haptic;
    };
    [[nodiscard]] bool apply_requests(double dt_s) noexcept;
    [[nodiscard]] RateIs judge(double rate_hz, double dt_s) noexcept;
    [[nodiscard]] Factors factors(double rate_hz, RateIs rate) const noexcept;
    [[nodiscard]] double picture_room() const noexcept;
    [[nodiscard]] double visual_level() const noexcept;
    [[nodiscard]] bool say_hold() noexcept;
    bool scale(bool haptic, double factor, double dt_s, LevelReason moved, LevelReason stuck) noexcept;

    GovernorSettings settings_;
    std::array<GovernedPath, kPathsMax> paths_{};
    std::size_t count_ = 0;

    RateFilter rate_;
    CostFit display_cost_;
    double display_fraction_ = 0.0;  // of a processor, that the visual process has; filtered
    double frame_s_ = 0.0;           // work of a frame, filtered; 0: none seen since the last change
    double frame_before_s_ = 0.0;
    double since_down_s_ = 1e9;
    double display_busy_ = 0.0;   // share of its time that it draws, filtered; 1: it never pauses
    bool display_binds_ = false;  // the last visual level that was given up, was for the picture's own goal
};

}  // namespace tact
