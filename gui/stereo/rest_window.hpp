// Measures a resting point: the mean of a second during which it stood still.
//
// Done     keeps sliding until stopped: another point may have to rest at the same time
// Rest     all samples of the last second within the allowed spread and without drift, at least 12 with distinct
//          timestamps. While the hand moves, the window slides, so that the user only has to hold still.
// Refuses  samples that are not numbers, and a silent source: measuring restarts; after kPatienceS it fails with a
//          message
// Thread   one; plain arithmetic
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "ipc/base/pose.hpp"

namespace tact {

class RestWindow {
public:
    static constexpr double kDriftShare =
        0.4;  // of the spread, from the earlier half of the window to the later one
    static constexpr double kFarthest = 2.5;  // of the spread, for any sample: the hand was still arriving
    static constexpr double kWindowS = 1.0, kSilentS = 0.25, kPatienceS = 20.0;
    static constexpr std::size_t kSamplesMin = 12, kSamplesMax = 4096;

    enum class State : std::uint8_t { idle, moving, resting, done, failed };

    // spread_m_max: root mean square about the mean.
    explicit RestWindow(double spread_m_max) : spread_m_max_(spread_m_max) {}
    void start(double now_s);
    void stop() { state_ = State::idle; }
    // taken_at_ns: a repeated sample is not counted again. good: valid according to the source.
    void add(double now_s, std::int64_t taken_at_ns, const Vec3& at_m, bool good);

    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] bool measuring() const { return state_ != State::idle && state_ != State::failed; }
    [[nodiscard]] double progress() const;  // of the window, 0 to 1, while it rests
    [[nodiscard]] const Vec3& mean_m() const { return mean_m_; }
    [[nodiscard]] double spread_m() const { return spread_m_; }
    [[nodiscard]] std::size_t samples() const { return samples_.size(); }
    [[nodiscard]] bool silent() const { return silent_; }
    // Progress as text for the user; `what` is measured, such as "the wand".
    [[nodiscard]] std::string text(const std::string& what) const;

private:
    struct Sample {
        double at_s;
        Vec3 at_m;
    };
    double spread_m_max_;
    State state_ = State::idle;
    std::deque<Sample> samples_;
    Vec3 mean_m_ = Vec3::Zero();
    double spread_m_ = 0.0, drift_m_ = 0.0, started_s_ = 0.0, heard_s_ = 0.0;
    std::int64_t newest_ns_ = 0;
    bool silent_ = false;
};

}  // namespace tact
