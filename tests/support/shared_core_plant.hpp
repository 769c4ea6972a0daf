// A model of a processor shared by a force loop, a display and other programs, for deterministic runs of the laws
// under identical loads.
//
// Sharing   busy programs get equal shares of the core, in steps of 0.25 ms (a fluid model of fair scheduling).
//           The force loop is always busy; the display while it draws a frame; each external program while it
//           runs.
// Display   a frame costs fixed_s + full_s * level with the levels at its start, times a random jitter per
//           frame (seeded); the frame rate is at most fps_max.
// Held      if the settings say so, updates reduce their work fraction, or the loop rests, as in rt/govern
// Governed  as in rt/servo: once per interval, with each applied frame reported once, and no decision before the
//           display has applied the levels where the law waits for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "rt/govern/display_watch.hpp"
#include "rt/govern/governor.hpp"
#include "rt/govern/rate_hold.hpp"

namespace tact {

struct PlantSettings {
    double update_s = 0.38e-3;  // processor time of one force update at haptic level 1
    double frame_fixed_s = 7e-3, frame_full_s = 45e-3;
    double frame_jitter = 0.05;  // standard deviation of its cost
    double fps_max = 20.0;
    bool free_running = true;  // false: updates run at the goal's rate, on a core of their own
    double seconds = 30.0;
    double interval_s = 0.1;
    bool hold = false;
    unsigned seed = 1;
};

// Parameters that change during a run.
struct Load {
    double programs = 0.0;      // number of running external programs
    double update_times = 1.0;  // factor on the cost of an update
    double frame_times = 1.0;   // factor on the variable cost of a frame
    double core_times = 1.0;    // factor on all costs: a slower core
};
using LoadTrace = std::function<Load(double t_s)>;

// Mean over a tenth of a second.
struct PlantSample {
    double t_s;  // end time
    double rate_hz, fps;
    double level, haptic_level;  // at the end
    double fresh;                // recomputed fraction of the updates' work
};

class SharedCorePlant {
public:
    static constexpr KnobSpec kMesh{.path = "gui.mesh", .floor = 0.01F, .start = 1.0F};
    static constexpr KnobSpec kForce{
        .path = "force", .floor = 0.2F, .start = 1.0F, .slew_per_s = 2.0F, .haptic = true};

    SharedCorePlant(const PlantSettings& p, const GovernorSettings& g)
        : p_(p), governor_(like(p, g)), random_(p.seed) {
        governor_.add(kMesh);
        governor_.add(kForce);
        governor_.set_held(p.hold);
    }

    const std::vector<PlantSample>& run(const LoadTrace& trace) {
        constexpr double kStep_s = 0.25e-3;
        const auto steps = static_cast<std::int64_t>(std::llround(p_.seconds / kStep_s));
        for (std::int64_t i = 0; i < steps; ++i) {
            t_s_ = static_cast<double>(i) * kStep_s;
            load_ = trace(t_s_);
            step(kStep_s);
        }
        return samples_;
    }
    void set_level(double level) {  // from now on, with the law "fixed"
        static_cast<void>(governor_.set_level(0, level));
        static_cast<void>(governor_.step(0.0, std::chrono::hours(1)));
    }
    [[nodiscard]] const Governor& governor() const { return governor_; }
    [[nodiscard]] const std::vector<PlantSample>& samples() const { return samples_; }
    [[nodiscard]] int changes() const { return changes_; }
    // Time of a frame at that level if drawn alone.
    [[nodiscard]] double frame_s(double level) const {
        return p_.frame_fixed_s + p_.frame_full_s * load_.frame_times * level;
    }

private:
    static constexpr double kFixed =
        0.04;  // fixed part of an update's cost, independent of its work fraction

    static GovernorSettings like(const PlantSettings& p, GovernorSettings g) {
        g.free_running = p.free_running;
        return g;
    }
    void step(double dt_s) {
        if (work_left_s_ <= 0.0 && t_s_ >= next_frame_s_) begin_frame();
        const bool drawing = work_left_s_ > 0.0;
        // A loop of fixed rate has a core of its own; the display then shares a core with the external programs.
        const bool resting = t_s_ < rest_until_s_;
        if (resting) interval_rest_s_ += dt_s;
        const double parties =
            (p_.free_running && !resting ? 1.0 : 0.0) + (drawing ? 1.0 : 0.0) + load_.programs;
        const double share = (parties > 1.0 ? dt_s / parties : dt_s) / load_.core_times;
        const double haptic = static_cast<double>(governor_.level(1));
        const double update_s =
            p_.update_s * load_.update_times * haptic * (kFixed + (1.0 - kFixed) * fresh_);
        const double made = resting           ? 0.0
                            : p_.free_running ? share / update_s
                                              : dt_s * std::min(governor_.settings().goal_hz, 1.0 / update_s);
        updates_ += made;
        interval_recomputed_ += made * fresh_;
        sample_fresh_ += made * fresh_;
        sample_updates_ += made;
        begun_ += made;
        for (; p_.hold && begun_ >= 1.0; begun_ -= 1.0) begin_update();
        if (drawing) {
            cpu_s_ += std::min(share, work_left_s_);
            work_left_s_ -= share;
            if (work_left_s_ <= 0.0) end_frame();
        }
        if (t_s_ - sample_at_s_ >= 0.1 - 1e-9) sample();
        const double since_s = t_s_ - interval_at_s_;
        if (since_s >= p_.interval_s - 1e-9) govern(since_s, update_s);
    }

    void begin_update() {
        const double goal_hz = governor_.settings().goal_hz;
        fresh_ = std::ceil(8.0 * hold_.work_fraction(now(), goal_hz)) / 8.0;
        if (governor_.level(0) < 1.0F) rest_until_s_ = t_s_ + hold_.rest_s(now(), goal_hz);
    }

    void begin_frame() {
        begun_s_ = t_s_;
        applied_ = sequence_;
        drawn_level_ = static_cast<double>(governor_.level(0));
        const double jitter = 1.0 + p_.frame_jitter * std::clamp(normal_(random_), -3.0, 3.0);
        work_left_s_ = frame_s(drawn_level_) * jitter;
        next_frame_s_ = t_s_ + 1.0 / p_.fps_max;
    }

    void end_frame() {
        ++frame_;
        ++sample_frames_;
        const auto look = watch_.take({.frame = frame_,
                                       .levels_sequence = applied_,
                                       .taken_at_ns = static_cast<std::int64_t>(t_s_ * 1e9),
                                       .work_s = t_s_ - begun_s_,
                                       .cpu_s = cpu_s_,
                                       .drawn = true});
        const bool waited = pending_;
        pending_ = watch_.pending(now());
        if (look) {
            const float before = governor_.level(0);
            static_cast<void>(governor_.update(*look));
            if (note(before)) return restart();
        }
        if (waited && !pending_ && governor_.settings().law == Law::elastic) restart();
    }

    void govern(double since_s, double update_s) {
        const double measured_hz = updates_ / since_s;
        double rate_hz = measured_hz;
        const double whole = kFixed + (1.0 - kFixed) * interval_recomputed_ / std::max(updates_, 1e-9);
        if (p_.hold) rate_hz = whole * updates_ / std::max(since_s - interval_rest_s_, 0.1 * since_s);
        if (!p_.free_running) rate_hz = std::min(1.0 / update_s, 1.1 * governor_.settings().goal_hz);
        pending_ = watch_.pending(now());
        if (!(pending_ && governor_.settings().law == Law::elastic)) {
            const float before = governor_.level(0);
            static_cast<void>(governor_.step(rate_hz, std::chrono::nanoseconds(std::llround(since_s * 1e9))));
            static_cast<void>(note(before));
        }
        restart();
    }

    bool note(float before) {
        if (governor_.level(0) == before) return false;
        watch_.asked(++sequence_, now());
        pending_ = true;
        ++changes_;
        return true;
    }
    void restart() {
        interval_at_s_ = t_s_;
        updates_ = interval_recomputed_ = interval_rest_s_ = 0.0;
    }
    void sample() {
        const double since_s = t_s_ - sample_at_s_;
        samples_.push_back({t_s_, sample_updates_ / since_s, sample_frames_ / since_s,
                            static_cast<double>(governor_.level(0)), static_cast<double>(governor_.level(1)),
                            sample_fresh_ / std::max(sample_updates_, 1e-9)});
        sample_at_s_ = t_s_;
        sample_updates_ = sample_frames_ = sample_fresh_ = 0.0;
    }
    [[nodiscard]] Instant now() const {
        return Instant{} + std::chrono::seconds(100) + std::chrono::nanoseconds(std::llround(t_s_ * 1e9));
    }

    PlantSettings p_;
    Governor governor_;
    DisplayWatch watch_;
    std::mt19937 random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
    Load load_{};
    std::vector<PlantSample> samples_;
    double t_s_ = 0.0, interval_at_s_ = 0.0, updates_ = 0.0, cpu_s_ = 0.0;
    double work_left_s_ = 0.0, next_frame_s_ = 0.0, begun_s_ = 0.0, drawn_level_ = 1.0;
    std::uint64_t sequence_ = 0, applied_ = 0, frame_ = 0;
    double sample_at_s_ = 0.0, sample_updates_ = 0.0, sample_frames_ = 0.0;
    int changes_ = 0;
    bool pending_ = false;
    RateHold hold_;
    double rest_until_s_ = -1.0, interval_rest_s_ = 0.0;
    double fresh_ = 1.0, begun_ = 0.0, interval_recomputed_ = 0.0, sample_fresh_ = 0.0;
};

}  // namespace tact
