// A point measured while it rests: the mean of a second during which it stood still.
//
// Done     goes on sliding until it is stopped: another point may have to rest at the same time
// Rest     all of the last second within the spread that is allowed and without a drift, at least 12 samples of their own instants. While the
//          hand moves the window goes on with it, so that a person only has to hold still.
// Refuses  what is not a number, and a source that fell silent: measuring begins anew; after kPatienceS it ends in words
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
    static constexpr double kFarthest =
        2.5;  // of the spread, that any sample may be off: the hand was still on its way
    static constexpr double kWindowS = 1.0, kSilentS = 0.25, kPatienceS = 20.0;
    static constexpr std::size_t kSamplesMin = 12, kSamplesMax = 4096;

    enum class State : std::uint8_t { idle, moving, resting, done, failed };

    // spread_m_max: root mean square about the mean.
    explicit RestWindow(double spread_m_max) : spread_m_max_(spread_m_max) {}
    void start(double now_s);
    void stop() { state_ = State::idle; }
    // taken_at_ns: a sample that was seen before is not counted again. good: the source says so.
    void add(double now_s, std::int64_t taken_at_ns, const Vec3& at_m, bool good);

    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] bool measuring() const { return state_ != State::idle && state_ != State::failed; }
    [[nodiscard]] double progress() const;  // of the window, 0 to 1, while it rests
    [[nodiscard]] const Vec3& mean_m() const { return mean_m_; }
    [[nodiscard]] double spread_m() const { return spread_m_; }
    [[nodiscard]] std::size_t samples() const { return samples_.size(); }
    [[nodiscard]] bool silent() const { return silent_; }
    // What is going on, for a person; `what` is measured, as "the wand".
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
