// Whole runs of the launcher: their reports, and their ends.
#include "deploy/tact/run.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/deploy_run_stand_ins.hpp"

namespace tact::launch {
namespace {

TEST_F(DeployRun, the_json_has_the_published_values_of_the_controller) {
    options_.gui = false;
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_EQ(report_["force_rate_hz"], 998.5);
    const auto& servo = report_["servo"];
    EXPECT_EQ(servo["overruns"], 3);
    EXPECT_EQ(servo["page_faults"], 5);
    EXPECT_EQ(servo["allocations"], 7);
    EXPECT_EQ(servo["schedule"], "FIFO");
    EXPECT_NEAR(servo["lateness_us"]["p50"].get<double>(), 2.0, 0.13);  // a bucket is 6 % wide
    EXPECT_NEAR(servo["lateness_us"]["p99"].get<double>(), 2.0, 0.13);
    EXPECT_EQ(servo["lateness_us"]["p999"], 50.0);  // the hundredth of 100 samples
    EXPECT_EQ(servo["lateness_us"]["max"], 50.0);
    ASSERT_EQ(report_["devices"].size(), 1U);  // the second hand reports nothing
    EXPECT_NE(report_["devices"][0]["notice"], "");
    EXPECT_EQ(report_["devices"][0]["bus"]["packets"], 1000);
    EXPECT_EQ(report_["devices"][0]["bus"]["checksum"], 3);
    EXPECT_EQ(report_["devices"][0]["bus"]["reconnects"], 1);
    EXPECT_EQ(report_["devices"][0]["bus"]["lost"], 0);
    EXPECT_EQ(report_["gui"]["fps"], 42.5);
    EXPECT_EQ(report_["gui"]["vertices"], 1234);
    EXPECT_EQ(report_["governor"]["law"], "sensitus");
    EXPECT_EQ(report_["governor"]["paths"]["gui.mesh"]["level"], 0.5);
    EXPECT_EQ(report_["state"], "active");
    EXPECT_EQ(report_["scene"]["checksum"], "000000000000abcd");
    ASSERT_EQ(report_["bodies"].size(), 1U);
    const auto& body = report_["bodies"][0];
    EXPECT_EQ(body["id"], 6);
    EXPECT_EQ(body["structure"], 0);
    EXPECT_EQ(body["name"], sample::structure().name);
    EXPECT_NEAR(body["pos_model_a"][0].get<double>(), 1e10 * sample::structure().home_com_model_m.x() + 3.0,
                1e-6);
    EXPECT_NEAR(body["quat_model_body_xyzw"][2].get<double>(), std::sqrt(0.5), 1e-9);
    EXPECT_TRUE(body["fixed"].get<bool>() && body["in_hand"].get<bool>());
    EXPECT_NEAR(report_["fit"]["offset_a"].get<double>(), 3.0, 1e-6);
    EXPECT_NEAR(report_["fit"]["angle_deg"].get<double>(), 90.0, 1e-6);
    EXPECT_NEAR(report_["fit"]["at_file_place"]["offset_a"].get<double>(), 0.0, 1e-9);
    EXPECT_TRUE(report_["ended"]["ok"].get<bool>());
    EXPECT_EQ(report_["ended"]["tact-rt"]["exit_code"], 0);
    EXPECT_GE(report_["seconds"].get<double>(), 0.3);
}

TEST_F(DeployRun, the_json_has_the_bodies_at_their_poses_of_the_last_cycle) {
    misbehave("moves at the end");
    options_.gui = false;
    ASSERT_EQ(run_until_seen(), 0) << said_;
    EXPECT_NEAR(report_["fit"]["offset_a"].get<double>(), 5.0, 1e-6);
    EXPECT_NEAR(report_["bodies"][0]["offset_a"].get<double>(), 5.0, 1e-6);
}

TEST_F(DeployRun, the_window_ends_the_run_and_its_screenshot_is_reported) {
    options_.screenshot = scratch_.path() / "new" / "picture.png";
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_TRUE(std::filesystem::exists(options_.screenshot));
    EXPECT_EQ(report_["ended"]["why"], "the time is over");
    EXPECT_EQ(report_["ended"]["tact-gui"]["exit_code"], 0);
}

TEST_F(DeployRun, out_collects_json_screenshot_and_samples) {
    options_.json.clear();
    options_.out = scratch_.path() / "all";
    ASSERT_EQ(run_until_seen(), 0) << said_;
    for (const char* const name : {"run.json", "run.csv", "run.png"})
        EXPECT_TRUE(std::filesystem::exists(scratch_.path() / "all" / name)) << name;
    const std::string csv = read_small(scratch_.path() / "all" / "run.csv");
    EXPECT_GE(std::count(csv.begin(), csv.end(), '\n'), 2);
    EXPECT_NE(csv.find(",active,999.00,"), std::string::npos);
}

TEST_F(DeployRun, a_dead_controller_ends_the_run_and_its_signal_is_reported) {
    misbehave("crash");
    options_.gui = false;
    EXPECT_EQ(run_until_seen(), 1);
    EXPECT_FALSE(report_["ended"]["ok"].get<bool>());
    EXPECT_EQ(report_["ended"]["tact-rt"]["signal"], SIGSEGV);
    EXPECT_NE(said_.find("tact-rt was killed by signal 11"), std::string::npos) << said_;
    EXPECT_EQ(report_["force_rate_hz"], 998.5) << "what it had published stays readable";
}

TEST_F(DeployRun, a_controller_that_refuses_to_start_is_reported_with_its_exit_code) {
    misbehave("refuse");
    EXPECT_EQ(run(), 1);
    EXPECT_EQ(report_["ended"]["tact-rt"]["exit_code"], 3);
    EXPECT_TRUE(report_["scene"]["checksum"].is_null());
}

TEST_F(DeployRun, a_window_that_dies_ends_the_controller_in_order) {
    misbehave("window");
    EXPECT_EQ(run(), 1);
    EXPECT_EQ(report_["ended"]["tact-gui"]["exit_code"], 4);
    EXPECT_EQ(report_["ended"]["tact-rt"]["exit_code"], 0);
}

TEST_F(DeployRun, a_controller_stopped_during_startup_counts_as_ended_in_order) {
    misbehave("early");
    options_.gui = false;
    EXPECT_EQ(run(), 0) << said_;
    EXPECT_EQ(report_["ended"]["tact-rt"]["signal"], SIGTERM);
    EXPECT_TRUE(report_["ended"]["ok"].get<bool>());
}

TEST_F(DeployRun, a_controller_that_hangs_is_killed_and_the_run_fails) {
    misbehave("ignore");
    options_.gui = false;
    options_.grace = std::chrono::milliseconds(100);
    EXPECT_EQ(run(), 1);
    EXPECT_EQ(report_["ended"]["tact-rt"]["signal"], SIGKILL);
    EXPECT_NE(said_.find("did not end on request"), std::string::npos) << said_;
}

TEST_F(DeployRun, a_signal_to_tact_ends_all_in_order) {
    options_.seconds = 0.0;
    const pid_t pid = fork();
    if (pid == 0) {
        const int code = run_scene(scene_, options_);
        std::fflush(nullptr);
        _exit(code);
    }
    Observer observer("default");
    EXPECT_TRUE(comes_up(observer));
    kill(pid, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(pid, &status, 0), pid);
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    report_ = nlohmann::json::parse(read_small(options_.json));
    EXPECT_EQ(report_["ended"]["why"], "requested by signal: Interrupt");
    EXPECT_EQ(report_["ended"]["tact-rt"]["exit_code"], 0);
}

TEST_F(DeployRun, the_kernel_ends_the_controller_if_tact_is_killed) {
    options_.seconds = 0.0;
    options_.gui = false;
    const pid_t pid = fork();
    if (pid == 0) {
        run_scene(scene_, options_);
        _exit(0);
    }
    Observer observer("default");
    EXPECT_TRUE(comes_up(observer));
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    EXPECT_TRUE(within_a_minute([&] {
        observer.poll();
        return !observer.attached();
    }));
    EXPECT_TRUE(observer.seen()) << "what it had published stays readable";
}

TEST_F(DeployRun, a_second_run_in_the_same_session_is_refused_before_anything_starts) {
    OwnedRegion<RtRegion> region;
    region.mark_ready();
    const LinkServer other("default", region.fd());  // and too busy to answer
    const std::string error = sample::error_of([&] { run_scene(scene_, options_); });
    EXPECT_NE(error.find("--session"), std::string::npos) << error;
}

TEST_F(DeployRun, the_socket_of_a_dead_controller_does_not_count_as_a_controller) {
    const pid_t pid = fork();
    if (pid == 0) {
        OwnedRegion<RtRegion> region;
        region.mark_ready();
        const LinkServer other("default", region.fd());
        kill(getpid(), SIGKILL);
    }
    ASSERT_EQ(waitpid(pid, nullptr, 0), pid);
    ASSERT_TRUE(std::filesystem::exists(scratch_.path() / "tact-default.sock"));
    options_.gui = false;
    EXPECT_EQ(run(), 0) << said_;
}

TEST_F(DeployRun, a_screenshot_without_a_window_is_refused) {
    options_.gui = false;
    options_.screenshot = "x.png";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("--no-gui"), std::string::npos);
}

TEST_F(DeployRun, a_broken_scene_is_refused_by_its_name) {
    std::ofstream(scene_, std::ios::trunc) << "not a scene";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("sample.tact"), std::string::npos);
}

}  // namespace
}  // namespace tact::launch

int main(int argc, char** argv) { return tact::launch::play(argc, argv); }
