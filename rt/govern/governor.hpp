// The one place that turns fidelity knobs.
//
// Runs on   servo thread, every so many milliseconds, constant time
// In        the rate of the force loop, and which paths are there
// Out       one level per path, within [floor, 1]; whether any changed
// Order     rate too low: visual levels first, all by the same factor; haptic ones only when no visual one
//           can give more. Rate to spare: haptic ones first. Down at once, up no faster than the knob's slew.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/knob.hpp"
#include "ipc/base/rt.hpp"
#include "rt/govern/law.hpp"

namespace tact {

struct GovernorSettings {
    Law law = Law::sensitus;
    double goal_hz = 1000.0;
    double gain = 0.5;        // s
    double tolerance = 0.02;  // epsilon
};

struct GovernedPath {
    KnobSpec knob;
    float level = 1.0F;
    float wished = 1.0F;  // by a person, for the law "fixed"
    bool present = true;  // an absent path (no GUI attached) keeps its level and takes no part
    LevelReason reason = LevelReason::start;
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

    bool set_goal_hz(double goal_hz) noexcept TACT_RT;                // false: not a rate
    bool set_level(std::size_t path, double level) noexcept TACT_RT;  // turns the law to "fixed"
    void set_law(Law law) noexcept TACT_RT;
    void set_present(std::size_t path, bool present) noexcept TACT_RT;

    [[nodiscard]] std::span<const GovernedPath> paths() const noexcept { return {paths_.data(), count_}; }
    [[nodiscard]] float level(std::size_t path) const noexcept { return paths_[path].level; }
    [[nodiscard]] const GovernorSettings& settings() const noexcept { return settings_; }

private:
    bool scale(bool haptic, double factor, double dt_s, RateIs rate) noexcept;

    GovernorSettings settings_;
    std::array<GovernedPath, kPathsMax> paths_{};
    std::size_t count_ = 0;
};

}  // namespace tact
