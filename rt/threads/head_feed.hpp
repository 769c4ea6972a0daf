// Publishes the filtered head pose in the screen frame (topic `head`) and the tracker's counters (topic `tracker`).
//
// Thread   "head", ordinary scheduling; reads every sample of a tracker of up to 500 Hz and publishes each once. Tests
//          call step() instead.
// Fails by the topic's state and link. The force does not depend on it.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "hal/api/tracker.hpp"
#include "hal/tracker/head_filter.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/head.hpp"

namespace tact {

struct HeadSettings {
    unsigned sensor = 0;    // on the glasses
    Pose T_screen_tracker;  // registration
    HeadFilterSettings filter;
};

class HeadFeed {
public:
    static constexpr Duration kEvery = std::chrono::milliseconds(2);
    static constexpr Duration kCountsEvery = std::chrono::milliseconds(100);

    // The topics outlive the feed.
    HeadFeed(const HeadSettings& settings, std::unique_ptr<Tracker> tracker, Latest<HeadTopic>& topic,
             Latest<TrackerTopic>& counts);
    ~HeadFeed();
    HeadFeed(const HeadFeed&) = delete;
    HeadFeed& operator=(const HeadFeed&) = delete;

    TrackerInfo open();  // the tracker; throws StartupError
    void start();        // the thread
    void step(Instant now) noexcept;

private:
    void publish() noexcept;
    void publish_counts(Instant now) noexcept;

    HeadSettings settings_;
    std::unique_ptr<Tracker> tracker_;
    Latest<HeadTopic>& topic_;
    Latest<TrackerTopic>& counts_;
    double rate_hz_ = 0.0;  // nominal rate of the tracker
    Instant counted_at_{};
    HeadFilter filter_;
    TrackerSample newest_;
    std::uint64_t filtered_ = 0;  // sequence number of the last filtered sample
    TrackerLink link_ = TrackerLink::closed;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
