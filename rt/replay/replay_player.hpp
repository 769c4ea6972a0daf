// Shows a replay in a window, as a controller would, and lets the window play, pause, step and seek.
//
// Forward   the replay computes every step up to the place
// Back      another replay begins from the start and computes up to the place, while the window keeps the picture that it
//           has; then the window attaches to that one. A model has no way back, and a recording holds no state of it
// Dry steps have no state to show: a time among them is the first regular step; a step number finds them all the same
// Times     of all topics: those of the recording, moved so that its first step is at the time at which the window came
// Thread    one
// Errors    StartupError: no window came
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ipc/shm/link.hpp"
#include "ipc/shm/region.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/replay/replay.hpp"

namespace tact {

class ReplayPlayer {
public:
    struct Settings {
        ReplaySettings replay;
        std::string session;
        double speed = 1.0, from_s = 0.0;  // from_s below 0: before the end
        double wait_s = 30.0;              // for a window
        bool can_run = false;              // as ReplayTopic::can_run
    };
    // first: at its first step.
    ReplayPlayer(Settings settings, std::unique_ptr<Replay> first);

    // Until the window has closed or stopped() is true.
    void run(const std::function<bool()>& stopped);

    [[nodiscard]] const Replay& replay() const { return *shown_; }
    [[nodiscard]] bool differed() const;  // in any replay so far
    [[nodiscard]] std::uint64_t seeks() const { return seeks_done_; }
    [[nodiscard]] double at_s() const { return at_s_; }
    [[nodiscard]] bool playing() const { return act_ == ReplayAct::playing; }

private:
    struct Place {
        double at_s = 0.0;
        std::uint64_t step = 0;  // 0: at_s counts
    };
    void open();
    void attend(int timeout_ms);
    void follow_window();
    void seek(const Place& place);
    void seek_on();
    void found();
    void play_on();
    void anchor();
    void publish();
    [[nodiscard]] bool reached(const Replay& replay) const;
    [[nodiscard]] double time_s(const RecordedStep& step) const;
    void compute(Replay& replay, double& at_s, std::int64_t& at_ns);

    const Settings settings_;
    std::unique_ptr<Replay> shown_;
    std::unique_ptr<Replay> fresh_;  // computes up to an earlier place
    std::unique_ptr<LinkServer> link_;
    MappedRegion<GuiRegion> window_;
    ReplayMarks marks_{};
    Duration shift_{0};
    ReplayAct act_ = ReplayAct::playing;
    bool began_ = false, attached_ = false, closed_ = false, play_ = true, differed_ = false;
    double speed_, at_s_ = 0.0;
    std::int64_t shown_ns_ = 0;
    double place_at_s_ = 0.0;  // that `fresh_` has reached
    std::int64_t place_ns_ = 0;
    double anchor_s_ = 0.0;  // the place at anchored_at_, from which it plays
    Instant anchored_at_{}, served_{}, published_{}, opened_{};
    Place place_{};
    std::uint64_t runs_ = 0, seeks_wanted_ = 0, seeks_done_ = 0, timelines_seen_ = 0;
};

}  // namespace tact
