// A recorded run replayed inside the test: orders of a visual process, rebuilt models, a fault; and a modified
// recording.
#include <gtest/gtest.h>

#include "ipc/record/recording_reader.hpp"
#include "ipc/recorder/recorder.hpp"
#include "rt/replay/replay_player.hpp"
#include "tests/scenario/rig.hpp"

namespace tact::scenario {
namespace {

// Records the rig's session on a thread of its own.
class Recording {
public:
    explicit Recording(const Rig& rig) : file_(rig.folder() / "run.h5") {
        settings_.file = file_;
        settings_.session = rig.session();
        settings_.program = "test";
        settings_.free_bytes_least = 0;
        settings_.stop = [this] { return stop_.load(); };
        thread_ = std::thread([this] {
            outcome_ = record::record(
                settings_, [](const std::string&) {}, [](const auto&) {});
        });
    }
    ~Recording() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }
    // Call it after the controller has ended.
    const record::RecorderOutcome& join() {
        thread_.join();
        return outcome_;
    }
    [[nodiscard]] const record::RecorderOutcome& outcome() const { return outcome_; }  // after join()
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
    record::RecorderSettings settings_;
    record::RecorderOutcome outcome_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

// An armed run of so many cycles, recorded without a loss.
void record_cycles(const Rig& rig, Recording& recording, std::uint64_t cycles) {
    Controller rt(rig, {"--arm"});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    ASSERT_TRUE(watch.cycles_pass(cycles));
    rt.child().stop();
    ASSERT_TRUE(rt.child().wait(std::chrono::minutes(1)));
    ASSERT_EQ(recording.join().progress.dropped, 0U);
}

ReplayResult again(Replay& replay) {
    while (replay.upcoming() != nullptr) replay.do_step();
    return replay.result();
}

std::string words(const ReplayResult& r) {
    if (!r.first) return "the same";
    const ReplayDifference& d = *r.first;
    return "step " + std::to_string(d.step) + ", " + d.what + ": " + std::to_string(d.recorded[0]) + " and " +
           std::to_string(d.replayed[0]);
}

TEST(ReplayScenario, orders_and_rebuilt_models_are_replayed_in_their_steps) {
    const Rig rig;
    Recording recording(rig);
    Controller rt(rig, {"--copies", "2"});
    Watch watch(rig);
    ASSERT_TRUE(watch.attach()) << rt.said();
    Visual visual(rig);
    ASSERT_TRUE(bring_to_force(visual, watch)) << rt.said();
    for (const CommandKind kind : {CommandKind::set_clash, CommandKind::set_laplacian}) {
        EXPECT_EQ(command(visual, watch, kind, 1.0), CommandResult::done);
        ASSERT_TRUE(watch.cycles_pass(200));
    }
    // The other density needs a rebuild.
    const std::uint32_t all = kDockingClash | kDockingLaplacian;
    ASSERT_TRUE(until([&] {
        visual.frame();
        const auto bodies = launch::newest(watch.region().bodies);
        return bodies && bodies->options == all && bodies->building == 0;
    })) << rt.said();
    ASSERT_TRUE(watch.cycles_pass(500));
    EXPECT_EQ(command(visual, watch, CommandKind::disarm), CommandResult::done);
    rt.child().stop();
    ASSERT_TRUE(rt.child().wait(std::chrono::minutes(1)));
    const record::RecorderOutcome& outcome = recording.join();
    ASSERT_EQ(outcome.end, record::RecorderEnd::controller_ended);
    ASSERT_EQ(outcome.progress.dropped, 0U);

    Replay replay({.recording = recording.file(), .scene = {}});
    EXPECT_EQ(replay.obstacle(), "");
    const ReplayResult r = again(replay);
    EXPECT_EQ(r.steps, outcome.progress.cycles);
    EXPECT_EQ(r.different, 0U) << words(r);
    EXPECT_GT(r.force_n_most, 0.01);
    // The region of the replay has the controller's final values.
    BodiesTopic was{}, is{};
    ASSERT_TRUE(watch.region().bodies.read(was));
    ASSERT_TRUE(replay.region()->bodies.read(is));
    EXPECT_EQ(was.options, is.options);
    EXPECT_EQ(std::memcmp(was.body, is.body, sizeof was.body), 0);
    // A second replay with another time offset: only differences of time matter.
    Replay later({.recording = recording.file(), .scene = {}});
    later.shift_by(std::chrono::hours(5));
    EXPECT_EQ(again(later).different, 0U);
}

TEST(ReplayScenario, a_changed_sample_is_found_at_its_step) {
    const Rig rig;
    Recording recording(rig);
    ASSERT_NO_FATAL_FAILURE(record_cycles(rig, recording, 900));
    const auto change = [&](std::uint64_t row, double by_m) {
        const Hdf5Handle file = hdf5::open_file(recording.file(), true);
        const auto hands = Hdf5Table::open(file.get(), kHandGroups[0], hand_columns(), sizeof(HandRow));
        HandRow h{};
        hands.read(row, 1, &h);
        h.t.pos_dev_m[0] += by_m;
        hands.write(row, 1, &h);
        return h.t.step;
    };
    std::uint64_t steps = 0;
    {
        Replay replay({.recording = recording.file(), .scene = {}});
        const ReplayResult r = again(replay);
        EXPECT_EQ(r.different, 0U) << words(r);
        steps = r.steps;
    }
    const std::uint64_t changed = change(steps - 200, 1e-9);
    Replay replay({.recording = recording.file(), .scene = {}});
    const ReplayResult r = again(replay);
    ASSERT_TRUE(r.first);
    EXPECT_EQ(r.first->step, changed);
    EXPECT_EQ(r.first->what, "force of the model");
    EXPECT_GT(r.different, 0U);
}

// A window without a picture, which moves a replay.
class PlayerWindow {
public:
    explicit PlayerWindow(std::string session) : session_(std::move(session)), link_(session_, own_.fd()) {
        own_.mark_ready();
    }
    ReplayTopic look() {
        LinkClient::News news = link_.poll();
        std::string refusal;
        if (news.left) ++left_, region_ = {};
        if (news.arrived) region_ = MappedRegion<RtRegion>::map(std::move(news.rt_fd), refusal);
        if (!region_.empty()) static_cast<void>(region_->replay.read(newest_));
        return newest_;
    }
    // True once it is so, within a while.
    template <class Condition>
    bool waits_for(Condition condition) {
        const Instant begin = Monotonic::now();
        while (Monotonic::now() - begin < std::chrono::seconds(60)) {
            if (const ReplayTopic t = look(); attached() && condition(t)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    void request(std::uint64_t seeks, double seek_s, std::uint64_t step, bool playing) {
        TimelineTopic t{};
        t.speed = 1.0;
        t.seeks = seeks;
        t.seek_s = seek_s;
        t.seek_step = step;
        t.playing = playing ? 1 : 0;
        own_->timeline.publish(t);
    }
    [[nodiscard]] bool attached() const { return !region_.empty(); }
    [[nodiscard]] const RtRegion& region() const { return *region_; }
    [[nodiscard]] int left() const { return left_; }

private:
    std::string session_;
    OwnedRegion<GuiRegion> own_;
    LinkClient link_;
    MappedRegion<RtRegion> region_;
    ReplayTopic newest_{};
    int left_ = 0;
};

TEST(ReplayScenario, a_window_pauses_steps_and_seeks_back_and_forth) {
    const Rig rig;
    Recording recording(rig);
    ASSERT_NO_FATAL_FAILURE(record_cycles(rig, recording, 2500));
    const record::RecorderOutcome& outcome = recording.outcome();
    // What a window must show at a step: the tool's place after so many steps of a replay of its own.
    const auto tool_after = [&](std::uint64_t steps) {
        Replay replay({.recording = recording.file(), .scene = {}});
        while (replay.result().steps < steps) replay.do_step();
        ToolTopic tool{};
        EXPECT_TRUE(replay.region()->tool[0].read(tool));
        return tool;
    };
    std::atomic<bool> stop{false};
    const std::string session = rig.session() + "r";
    std::thread player_thread([&] {
        const ReplaySettings settings{.recording = recording.file(), .scene = {}};
        ReplayPlayer player({.replay = settings, .session = session}, std::make_unique<Replay>(settings));
        player.run([&] { return stop.load(); });
        EXPECT_FALSE(player.differed());
    });
    PlayerWindow window(session);
    const auto act = [](const ReplayTopic& t) { return static_cast<ReplayAct>(t.act); };
    EXPECT_TRUE(
        window.waits_for([&](const ReplayTopic& t) { return act(t) == ReplayAct::playing && t.at_s > 0.3; }));
    window.request(0, 0.0, 0, false);
    ASSERT_TRUE(window.waits_for([&](const ReplayTopic& t) { return act(t) == ReplayAct::paused; }));
    EXPECT_NEAR(window.look().duration_s, 1e-3 * static_cast<double>(outcome.progress.cycles), 1.5);
    EXPECT_EQ(window.look().steps, outcome.progress.cycles);
    const std::uint64_t here = window.look().step;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(window.look().step, here);  // it waits
    std::uint64_t seeks = 0;
    const auto shows = [&](std::uint64_t step) {
        window.request(++seeks, 0.0, step, false);
        ASSERT_TRUE(window.waits_for([&](const ReplayTopic& t) { return t.seeks == seeks; })) << step;
        const ReplayTopic t = window.look();
        EXPECT_EQ(t.step, step);
        EXPECT_EQ(act(t), ReplayAct::paused);
        EXPECT_EQ(t.exact, 1);
        ToolTopic is{};
        ASSERT_TRUE(window.region().tool[0].read(is));
        const ToolTopic was = tool_after(step);
        EXPECT_EQ(std::memcmp(is.pos_world_m, was.pos_world_m, sizeof is.pos_world_m), 0) << step;
        EXPECT_EQ(is.cycle, was.cycle);
        // One clock for all topics. In dry steps the sample of an emulated device is up to a second old; the recording is older.
        EXPECT_LT(std::abs(is.taken_at_ns - t.shown_ns), 1'200'000'000);
    };
    shows(here + 1);
    EXPECT_EQ(window.left(), 0);  // forward is the same replay
    shows(here);
    EXPECT_EQ(window.left(), 1);
    shows(here / 2);
    shows(here + 700);
    // A time: the last step that is not after it.
    window.request(++seeks, 1.5, 0, false);
    ASSERT_TRUE(window.waits_for([&](const ReplayTopic& t) { return t.seeks == seeks; }));
    EXPECT_LE(window.look().at_s, 1.5);
    EXPECT_GT(window.look().at_s, 1.49);
    // The beginning: the first step that is not dry, so there is a state to show.
    window.request(++seeks, 0.0, 0, false);
    ASSERT_TRUE(window.waits_for([&](const ReplayTopic& t) { return t.seeks == seeks; }));
    StartTopic start{};
    ASSERT_TRUE(window.region().start.read(start));
    EXPECT_GT(start.dry_steps, 0U);
    EXPECT_EQ(window.look().step, start.dry_steps + 1);
    // To the end, and on from there nothing plays.
    window.request(++seeks, 1e6, 0, true);
    ASSERT_TRUE(window.waits_for([&](const ReplayTopic& t) { return act(t) == ReplayAct::ended; }));
    EXPECT_EQ(window.look().step, outcome.progress.cycles);
    // Impossible requests change nothing.
    window.request(++seeks, std::nan(""), 0, true);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(act(window.look()), ReplayAct::ended);
    EXPECT_EQ(window.look().seeks, seeks - 1);
    stop = true;
    player_thread.join();
}

}  // namespace
}  // namespace tact::scenario
