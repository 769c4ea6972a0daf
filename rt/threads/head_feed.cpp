#include "rt/threads/head_feed.hpp"

#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "ipc/base/servo_clock.hpp"

namespace tact {

namespace {

const char* words(TrackerLink link) noexcept {
    switch (link) {
        case TrackerLink::closed:
            return "closed";
        case TrackerLink::up:
            return "its link is up";
        case TrackerLink::down:
            return "its interface is down";
        case TrackerLink::bus_off:
            return "its bus is off after errors";
        case TrackerLink::gone:
            return "its interface or connection is gone; retrying twice per second";
    }
    return "unknown";
}

void put(const Vec3& v, double (&out)[3]) noexcept { std::copy_n(v.data(), 3, out); }

}  // namespace

HeadFeed::HeadFeed(const HeadSettings& settings, std::unique_ptr<Tracker> tracker, Latest<HeadTopic>& topic,
                   Latest<TrackerTopic>& counts)
    : settings_(settings),
      tracker_(std::move(tracker)),
      topic_(topic),
      counts_(counts),
      filter_(settings.filter) {}

HeadFeed::~HeadFeed() {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

TrackerInfo HeadFeed::open() {
    TrackerInfo info = tracker_->open();
    rate_hz_ = info.rate_hz;
    return info;
}

void HeadFeed::start() {
    // The new thread inherits a mask that blocks all signals; main handles them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] {
        pthread_setname_np(pthread_self(), "head");
        ServoClock clock(Duration{0});
        while (!leave_.load(std::memory_order_relaxed)) {
            step(clock.now());
            clock.wait_until(clock.now() + kEvery);
        }
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void HeadFeed::step(Instant now) noexcept {
    const TrackerState before = newest_.state;
    static_cast<void>(tracker_->read(settings_.sensor, newest_, now));
    const TrackerLink link = tracker_->health().link;
    const bool fresh = newest_.sequence != filtered_;
    if (fresh) {
        filtered_ = newest_.sequence;
        filter_.add(newest_.taken_at, settings_.T_screen_tracker * newest_.T_tracker_sensor);
    }
    if (link != link_) {
        if (link != TrackerLink::up || link_ != TrackerLink::closed)
            spdlog::info("head tracker: {}", words(link));
        link_ = link;
        publish();
    } else if (fresh || newest_.state != before) {
        publish();
    }
    if (now - counted_at_ >= kCountsEvery) publish_counts(now);
}

void HeadFeed::publish_counts(Instant now) noexcept {
    counted_at_ = now;
    const TrackerHealth h = tracker_->health();
    TrackerTopic t{};
    t.taken_at_ns = to_ns(now);
    t.age_ns = newest_.sequence > 0 ? std::max<std::int64_t>((now - newest_.taken_at).count(), 0) : -1;
    t.rate_hz = rate_hz_;
    t.frames = h.frames;
    t.samples = h.samples;
    t.missed = h.missed;
    t.refused = h.refused;
    t.dropped = h.dropped;
    t.floods = h.floods;
    t.bus_errors = h.bus_errors;
    t.link_losses = h.link_losses;
    t.reopened = h.reopened;
    t.state = static_cast<std::uint8_t>(newest_.state);
    t.link = static_cast<std::uint8_t>(link_);
    counts_.publish(t);
}

void HeadFeed::publish() noexcept {
    HeadTopic h{};
    h.taken_at_ns = to_ns(filter_.taken_at());
    h.sequence = filtered_;
    const bool fresh = newest_.state == TrackerState::fresh;
    put(filter_.pose().p_m, h.pos_screen_m);
    std::copy_n(filter_.pose().q.coeffs().data(), 4, h.quat_screen_head_xyzw);
    // Zero velocity if the tracker has lost the head.
    put(fresh ? filter_.twist().linear_m_s : Vec3(Vec3::Zero()), h.velocity_screen_m_s);
    put(fresh ? filter_.twist().angular_rad_s : Vec3(Vec3::Zero()), h.angular_screen_rad_s);
    h.quality = newest_.quality;
    h.distortion = newest_.distortion;
    h.state = static_cast<std::uint8_t>(newest_.state);
    h.link = static_cast<std::uint8_t>(link_);
    topic_.publish(h);
}

}  // namespace tact
