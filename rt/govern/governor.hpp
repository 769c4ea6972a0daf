// Holds the fidelity level of each path and moves the levels by a named law (law.hpp).
//
// Runs on   servo thread: step() once an interval, update() for each frame that applied the levels; constant time
// In        rate of the force loop, cost of the display, and the paths that are present
// Out       one level per path, within [floor, 1]; whether any changed
// Fitted    the level of a fitted path comes from level_fit.hpp; the law moves the budget of such a path instead
// Goals     the force rate, always; the display rate, where a goal is set and a visual process is attached
// Order     rate too low: visual levels first; haptic paths only when no visual level can
//           fall further. Rate to spare: haptic paths first. Levels fall at once and rise no faster than the
//           knob's slew rate; visual levels rise only where the display has time to spare too
// Visual    law "sensitus": all by the same factor. Law "elastic": by marginal gain (README.md). A path that would
//           shorten a frame by less than kWorthGain of it is not lowered
// Wind-up   none: the clamped levels are the only integrator state
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/knob.hpp"
#include "ipc/base/rt.hpp"
#include "rt/govern/display_cost.hpp"
#include "rt/govern/law.hpp"
#include "rt/govern/rate_filter.hpp"

namespace tact {

struct GovernorSettings {
    Law law = kDefaultLaw;
    double goal_hz = 1000.0;
    double display_goal_hz = 0.0;  // 0: no goal for the display rate
    double force_level_min = 0.0;  // the law never lowers the haptic level below it
    double gain = 0.5;             // gain s of the law "sensitus"
    double tolerance = 0.02;       // relative tolerance of the law "sensitus"
    // A freely running loop shares its processor: its rate moves the budget of fitted paths. At a fixed rate it does not.
    bool free_running = false;
};

struct GovernedPath {
    KnobSpec knob;
    float level = 1.0F;
    float requested = 1.0F;  // level set by a person, for the law "fixed"
    bool present = true;     // an absent path (no GUI attached) keeps its level
    // The level of a fitted path comes from level_fit.hpp; the law moves its budget by the factor for its kind.
    bool fitted = false;
    float budget = 1.0F;
    LevelReason reason = LevelReason::start;
};

// Cost of a frame that was drawn with the present levels.
struct DisplaySample {
    double work_s = 0.0;            // time to draw it, without the pause of a frame-rate limit
    double processor_s = 0.0;       // processor time of the visual process since the previous frame
    double period_s = 0.0;          // time since the previous frame
    DisplayCost::PerPath path_s{};  // cost of each visual path, by its index in the governor; 0: no report
};

class Governor {
public:
    static constexpr std::size_t kPathsMax = DisplayCost::kPathsMax;
    static constexpr double kWorthGain = 0.02;

    explicit Governor(const GovernorSettings& settings) noexcept;

    // Call before the loop starts. Returns the index of the path; kPathsMax where the table is full or the knob
    // is impossible.
    std::size_t add(const KnobSpec& knob) noexcept;
    // Puts another load on the path, at its start level. A level that a person set is then approached at the
    // knob's slew rate. An impossible knob changes nothing.
    void replace(std::size_t path, const KnobSpec& knob) noexcept TACT_RT;
    // Applies the law to the rate of the last interval, whose length is dt. True: a level or its reason changed.
    bool step(double rate_hz, Duration dt) noexcept TACT_RT;
    // Call once for each frame that applied the present levels. True as for step().
    bool update(const DisplaySample& picture) noexcept TACT_RT;

    bool set_goal_hz(double goal_hz) noexcept TACT_RT;                // false: not a rate
    bool set_level(std::size_t path, double level) noexcept TACT_RT;  // selects the law "fixed"
    // The same before the loop starts: at once, without slew. False: no such path or level.
    bool start_at_level(std::size_t path, double level) noexcept;
    void set_law(Law law) noexcept TACT_RT;
    // Makes the path a fitted one and sets its level; refused under the law "fixed". True: the level changed.
    bool set_fitted_level(std::size_t path, float level, LevelReason reason) noexcept TACT_RT;
    void set_present(std::size_t path, bool present) noexcept TACT_RT;
    // A display at rest costs nothing and is not drawn at the levels: visual paths then take no part.
    void set_display_resting(bool resting) noexcept TACT_RT { resting_ = resting; }
    // False: steps that were asked for less work did all of it, so only the display holds the rate (rate_hold.hpp does not).
    void set_held(bool held) noexcept TACT_RT { held_ = held; }
    [[nodiscard]] bool held() const noexcept { return held_; }

    [[nodiscard]] std::span<const GovernedPath> paths() const noexcept { return {paths_.data(), count_}; }
    [[nodiscard]] float level(std::size_t path) const noexcept { return paths_[path].level; }
    // True: a visual path is above its floor, and lowering it would save time.
    [[nodiscard]] bool visual_can_give() const noexcept;
    [[nodiscard]] const GovernorSettings& settings() const noexcept { return settings_; }

private:
    struct Factors {
        double visual, haptic;
    };
    [[nodiscard]] bool apply_requests(double dt_s) noexcept;
    [[nodiscard]] RateIs judge(double rate_hz, double dt_s) noexcept;
    [[nodiscard]] Factors factors(double rate_hz, RateIs rate) const noexcept;
    [[nodiscard]] double display_margin() const noexcept;
    [[nodiscard]] DisplayCost::PerPath visual_levels() const noexcept;
    [[nodiscard]] bool takes_part(const GovernedPath& path) const noexcept {
        return path.present && (path.knob.haptic || !resting_);
    }
    [[nodiscard]] bool say_hold() noexcept;
    // The conditions are different ones now.
    void forget_rate() noexcept {
        rate_.restart();
        given_up_ = 0.0;
    }
    void damp(RateIs rate) noexcept;
    bool scale(bool haptic, double factor, double dt_s, LevelReason moved, LevelReason stuck) noexcept;
    bool scale_visual(double factor, double dt_s, LevelReason moved, LevelReason stuck) noexcept;
    bool rebalance_visual() noexcept;

    GovernorSettings settings_;
    std::array<GovernedPath, kPathsMax> paths_{};
    std::size_t count_ = 0;

    RateFilter rate_;
    DisplayCost display_cost_;
    double display_fraction_ = 0.0;  // fraction of one processor used by the visual process; filtered
    double frame_s_ = 0.0;           // time to draw a frame, filtered; 0: no frame since the last change
    std::array<double, 2> frames_before_s_{};  // of the last two frames; 0: none since the last change
    double since_down_s_ = 1e9;
    double damping_ = 1.0;       // of the steps of the law "elastic"
    double busy_growth_ = 1.0;   // the same, while the display never pauses
    double alone_growth_ = 1.0;  // the same, of small errors while only the display holds the rate
    bool held_ = true;
    RateIs damped_ = RateIs::right;  // direction of the last step
    double scaled_ln_ = 0.0;         // size of the last step of the visual levels, in ln V
    double given_up_ = 0.0;          // lost to a large error and not yet given back, in ln V
    double since_visual_s_ = 0.0;    // since a visual level moved
    double display_busy_ = 0.0;      // fraction of the time spent drawing, filtered; 1: no pauses
    bool resting_ = false;           // nothing is drawn at the levels
    bool display_binds_ = false;     // the last fall of a visual level was for the display goal
};

}  // namespace tact
