// The head topic from an emulated tracker, in lockstep with simulated time.
#include "rt/threads/head_feed.hpp"

#include <gtest/gtest.h>

#include "hal/sim/sim_tracker.hpp"
#include "hal/tracker_registry.hpp"
#include "ipc/base/error.hpp"
#include "ipc/topics/text.hpp"

namespace tact::threads_head_feed_test {
namespace {

using std::chrono::milliseconds;

class Feed : public testing::Test {
protected:
    Feed() {
        auto tracker = std::make_unique<SimTracker>();
        tracker_ = tracker.get();
        settings_.T_screen_tracker = {Vec3(0.1, -0.2, 0.3), quat_from_rotation_vector(Vec3(0.0, 1.5, 0.0))};
        feed_ = std::make_unique<HeadFeed>(settings_, std::move(tracker), topic_, counts_);
        feed_->open();
    }
    void run(Duration d) {
        for (const Instant end = now_ + d; now_ < end;) feed_->step(now_ += HeadFeed::kEvery);
    }
    HeadTopic head() const {
        HeadTopic h{};
        EXPECT_TRUE(topic_.read(h));
        return h;
    }
    static Vec3 at(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

    Latest<HeadTopic> topic_{};
    Latest<TrackerTopic> counts_{};
    HeadSettings settings_;
    SimTracker* tracker_ = nullptr;
    std::unique_ptr<HeadFeed> feed_;
    Instant now_ = instant_from_ns(5'000'000'000);
};

TEST_F(Feed, publishes_each_sample_once_in_the_screen_frame) {
    run(milliseconds(1000));
    const HeadTopic h = head();
    EXPECT_EQ(h.state, static_cast<std::uint8_t>(TrackerState::fresh));
    EXPECT_EQ(h.link, static_cast<std::uint8_t>(TrackerLink::up));
    EXPECT_NEAR(static_cast<double>(h.sequence), 240.0, 5.0);
    EXPECT_NEAR(static_cast<double>(topic_.count()), static_cast<double>(h.sequence), 3.0);
    // The tolerance allows noise and filter lag at head speed, but is far below the offset between the frames.
    const Pose T = settings_.T_screen_tracker * tracker_->head().at(0, instant_from_ns(h.taken_at_ns));
    EXPECT_LT((at(h.pos_screen_m) - T.p_m).norm(), 0.02);
    const Quat q(h.quat_screen_head_xyzw[3], h.quat_screen_head_xyzw[0], h.quat_screen_head_xyzw[1],
                 h.quat_screen_head_xyzw[2]);
    EXPECT_LT(rotation_vector_rad(q * T.q.conjugate()).norm(), 0.1);
    EXPECT_GT(at(h.velocity_screen_m_s).norm(), 0.0);
}

TEST_F(Feed, a_silent_tracker_is_frozen_then_lost_and_the_head_keeps_its_pose) {
    run(milliseconds(500));
    tracker_->inject(TrackerFault::silent);
    run(milliseconds(100));
    const HeadTopic frozen = head();
    EXPECT_EQ(frozen.state, static_cast<std::uint8_t>(TrackerState::frozen));
    EXPECT_EQ(at(frozen.velocity_screen_m_s), Vec3(Vec3::Zero()));
    run(milliseconds(2000));
    const HeadTopic lost = head();
    EXPECT_EQ(lost.state, static_cast<std::uint8_t>(TrackerState::lost));
    EXPECT_EQ(at(lost.pos_screen_m), at(frozen.pos_screen_m));
    tracker_->inject(TrackerFault::none);
    run(milliseconds(100));
    EXPECT_EQ(head().state, static_cast<std::uint8_t>(TrackerState::fresh));
}

TEST_F(Feed, reports_loss_and_return_of_the_link) {
    run(milliseconds(100));
    tracker_->inject(TrackerFault::gone);
    run(milliseconds(20));
    EXPECT_EQ(head().link, static_cast<std::uint8_t>(TrackerLink::gone));
    tracker_->inject(TrackerFault::none);
    run(milliseconds(1000));
    EXPECT_EQ(head().link, static_cast<std::uint8_t>(TrackerLink::up));
}

TEST_F(Feed, publishes_sample_counts_and_age_ten_times_a_second) {
    TrackerTopic t{};
    run(milliseconds(1000));
    ASSERT_TRUE(counts_.read(t));
    EXPECT_NEAR(static_cast<double>(counts_.count()), 10.0, 1.0);
    EXPECT_LE(t.samples, tracker_->health().samples);
    EXPECT_GT(t.samples + 30, tracker_->health().samples);  // at most 0.1 s old
    EXPECT_GT(t.rate_hz, 0.0);
    EXPECT_GE(t.age_ns, 0);
    EXPECT_LT(t.age_ns, 50'000'000);
    tracker_->inject(TrackerFault::silent);
    run(milliseconds(2000));
    ASSERT_TRUE(counts_.read(t));
    EXPECT_EQ(t.state, static_cast<std::uint8_t>(TrackerState::lost));
    EXPECT_GT(t.age_ns, 1'500'000'000);
    tracker_->inject(TrackerFault::gone);
    run(milliseconds(300));
    ASSERT_TRUE(counts_.read(t));
    EXPECT_EQ(t.link, static_cast<std::uint8_t>(TrackerLink::gone));
    EXPECT_GE(t.link_losses, 1U);
}

TEST(HeadFeedThread, publishes_by_itself_and_ends_with_its_object) {
    Latest<HeadTopic> topic{};
    Latest<TrackerTopic> counts{};
    {
        HeadFeed feed({}, make_tracker({.driver = "sim", .interface = "", .sim = {}}), topic, counts);
        feed.open();
        feed.start();
        const Instant end = Monotonic::now() + std::chrono::minutes(1);
        while (topic.count() < 10 && Monotonic::now() < end) std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_GE(topic.count(), 10U);
}

TEST(TrackerRegistry, makes_the_named_tracker_and_lists_all_names_in_its_error) {
    EXPECT_EQ(make_tracker({}), nullptr);
    for (const TrackerEntry& t : tracker_drivers()) {
        TrackerSettings settings{.driver = t.name, .interface = "can0", .sim = {}};
        settings.igtl.names = {"HeadToTracker"};
        EXPECT_NO_THROW(static_cast<void>(make_tracker(settings))) << t.name;
    }
    try {
        static_cast<void>(make_tracker({.driver = "magic", .interface = "", .sim = {}}));
        FAIL();
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("none, sim, can"), std::string::npos);
    }
}

TEST(HeadTopicText, names_the_states_and_links_of_the_tracker) {
    const auto state = [](TrackerState s) {
        return std::string(head_state_text(static_cast<std::uint8_t>(s)));
    };
    EXPECT_EQ(state(TrackerState::lost), "lost");
    EXPECT_EQ(state(TrackerState::frozen), "frozen");
    EXPECT_EQ(state(TrackerState::fresh), "fresh");
    const auto link = [](TrackerLink l) { return std::string(head_link_text(static_cast<std::uint8_t>(l))); };
    EXPECT_EQ(link(TrackerLink::closed), "closed");
    EXPECT_EQ(link(TrackerLink::up), "up");
    EXPECT_EQ(link(TrackerLink::down), "down");
    EXPECT_EQ(link(TrackerLink::bus_off), "bus off");
    EXPECT_EQ(link(TrackerLink::gone), "gone");
}

}  // namespace
}  // namespace tact::threads_head_feed_test
