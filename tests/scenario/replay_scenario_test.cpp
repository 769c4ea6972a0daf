// A recorded run replayed inside the test: orders of a visual process, rebuilt models, a fault; and a modified
// recording.
#include <gtest/gtest.h>

#include "ipc/record/recording_reader.hpp"
#include "ipc/recorder/recorder.hpp"
#include "rt/replay/replay.hpp"
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
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
    record::RecorderSettings settings_;
    record::RecorderOutcome outcome_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

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
    {
        Controller rt(rig, {"--arm"});
        Watch watch(rig);
        ASSERT_TRUE(watch.attach()) << rt.said();
        ASSERT_TRUE(watch.cycles_pass(900));
        rt.child().stop();
        ASSERT_TRUE(rt.child().wait(std::chrono::minutes(1)));
    }
    ASSERT_EQ(recording.join().progress.dropped, 0U);
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

}  // namespace
}  // namespace tact::scenario
