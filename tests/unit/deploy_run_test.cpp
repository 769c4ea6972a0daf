// Whole runs of the launcher with stand-ins for the two programs: this very file under the names tact-rt and
// tact-gui. The stand-in for the controller publishes a real region with known numbers, the one for the
// window begins its time when the controller is up; MISBEHAVE tells them how to end.
#include "deploy/tact/run.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"
#include "tests/unit/assets_samples.hpp"

namespace tact::launch {
namespace {

volatile sig_atomic_t asked_to_end = 0;

std::string value_of(int argc, char** argv, const std::string& option) {
    for (int i = 1; i + 1 < argc; ++i)
        if (argv[i] == option) return argv[i + 1];
    return "";
}

std::string misbehaviour() {
    const char* const m = std::getenv("MISBEHAVE");
    return m != nullptr ? m : "";
}

void fill(RtRegion& region, std::uint64_t cycle) {
    HealthTopic h{};
    h.taken_at_ns = to_ns(Monotonic::now());
    h.cycle = cycle;
    h.period_ns = 1'000'000;
    h.force_rate_hz = 999.0;
    h.force_rate_mean_hz = 998.5;
    h.overruns = 3;
    h.page_faults = 5;
    h.allocations = 7;
    h.schedule_flags = kScheduleFifo;
    h.gui_fps = 42.5;
    h.gui_vertices = 1234;
    h.gui_attached = 1;
    h.state = static_cast<std::uint8_t>(RunState::active);
    region.health.publish(h);
    DurationHistogram lateness;
    for (int i = 0; i < 99; ++i) lateness.add(std::chrono::nanoseconds(2000));
    lateness.add(std::chrono::nanoseconds(50000));
    LatenessTopic l{};
    std::copy(lateness.counts().begin(), lateness.counts().end(), l.counts);
    l.total = lateness.total();
    l.max_ns = lateness.max_ns();
    region.lateness.publish(l);
    LevelsTopic levels{};
    std::strcpy(levels.law, "sensitus");
    levels.goal_hz = 800.0;
    levels.count = 1;
    std::strcpy(levels.path[0].path, kMeshPath);
    levels.path[0].level = 0.5F;
    levels.path[0].items = 600;
    region.levels.publish(levels);
    // 3 A off and turned by 90 degrees about z.
    BodiesTopic bodies{};
    bodies.count = 1;
    const Vec3 home = sample::structure().home_com_model_m;
    bodies.body[0] = {
        {home.x() + 3e-10, home.y(), home.z()}, {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}, 6, 0, kBodyFixed};
    region.bodies.publish(bodies);
}

int controller(int argc, char** argv) {
    if (misbehaviour() == "ignore") {
        signal(SIGTERM, SIG_IGN);
    } else if (misbehaviour() != "early") {
        struct sigaction action {};
        action.sa_handler = [](int) { asked_to_end = 1; };
        sigaction(SIGTERM, &action, nullptr);
    }
    if (misbehaviour() == "refuse") return 3;
    OwnedRegion<RtRegion> region;
    std::strcpy(region->scene_path, argv[1]);
    region->scene_checksum = 0xABCD;
    fill(*region, 0);  // whoever finds the region finds something in it
    region.mark_ready();
    LinkServer link(value_of(argc, argv, "--session"), region.fd());
    const Instant start = Monotonic::now();
    std::uint64_t cycle = 1;
    for (; asked_to_end == 0; ++cycle) {
        link.poll(5);
        fill(*region, cycle);
        const char* const life_s = std::getenv("LIFE_S");
        if (misbehaviour() == "crash" && to_s(Monotonic::now() - start) > std::atof(life_s)) {
            signal(SIGSEGV, SIG_DFL);  // a sanitizer would make an exit code of it
            raise(SIGSEGV);
        }
    }
    fill(*region, cycle);
    return 0;
}

// Lives as long as --seconds says from the controller's coming on, writes its "picture" and ends.
int window(int argc, char** argv) {
    LinkClient link(value_of(argc, argv, "--session"), -1);
    while (!link.attached()) {
        link.poll();
        ::poll(nullptr, 0, 2);
    }
    const std::string seconds = value_of(argc, argv, "--seconds");
    if (misbehaviour() == "window") return 4;
    ::poll(nullptr, 0, seconds.empty() ? 600'000 : static_cast<int>(std::stod(seconds) * 1000));
    if (const auto picture = value_of(argc, argv, "--screenshot"); !picture.empty())
        std::ofstream(picture) << "PNG";
    return 0;
}

// Leaves what it was asked in the folder that it should write to.
int prep(int argc, char** argv) {
    if (misbehaviour() == "prep") return 5;
    std::ofstream said(value_of(argc, argv, "-o") + "/asked.txt");
    for (int i = 1; i < argc; ++i) said << argv[i] << '\n';
    return 0;
}

class DeployRun : public testing::Test {
protected:
    void SetUp() override {
        setenv("TACT_RUNTIME_DIR", scratch_.path().c_str(), 1);
        setenv("DISPLAY", ":0", 0);  // the stand-in opens no window
        const auto self = std::filesystem::read_symlink("/proc/self/exe");
        for (const char* const name : {"tact-rt", "tact-gui", "tact-prep"})
            std::filesystem::create_symlink(self, scratch_.path() / name);
        scene_ = scratch_.path() / "sample.tact";
        sample::scene().write(scene_);
        options_.programs = scratch_.path();
        options_.json = scratch_.path() / "out" / "run.json";
        options_.seconds = 0.3;
        options_.grace = std::chrono::minutes(1);  // a busy machine must not be taken for a hang
    }
    void TearDown() override { unsetenv("MISBEHAVE"); }
    static void misbehave(const char* how) { setenv("MISBEHAVE", how, 1); }

    int run() {
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int code = run_scene(scene_, options_);
        said_ = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
        const auto json = options_.json.empty() ? options_.out / "run.json" : options_.json;
        if (std::filesystem::exists(json)) report_ = nlohmann::json::parse(read_small(json));
        return code;
    }

    // Where the machine stood still, tact may not have seen the controller in so short a run: then a longer
    // one.
    int run_until_seen() {
        int code = -1;
        for (const double seconds : {0.3, 10.0, 60.0}) {
            options_.seconds = seconds;
            setenv("LIFE_S", std::to_string(seconds).c_str(), 1);
            code = run();
            if (report_.contains("scene") && !report_["scene"]["checksum"].is_null()) break;
        }
        return code;
    }

    // The same for a run with --save, which ends with an error where the controller was not seen.
    std::string error_once_seen() {
        std::string error;
        for (const double seconds : {0.3, 10.0, 60.0}) {
            options_.seconds = seconds;
            testing::internal::CaptureStdout();
            error = sample::error_of([&] { run_scene(scene_, options_); });
            (void)testing::internal::GetCapturedStdout();
            if (error.find("never said where") == std::string::npos) break;
        }
        return error;
    }

    template <class F>
    static bool within_a_minute(F&& wanted) {
        const Instant end = Monotonic::now() + std::chrono::minutes(1);
        while (!wanted() && Monotonic::now() < end) ::poll(nullptr, 0, 10);
        return wanted();
    }
    static bool comes_up(Observer& observer) {
        return within_a_minute([&] {
            observer.poll();
            return observer.attached();
        });
    }

    ScratchFolder scratch_;
    std::filesystem::path scene_;
    RunOptions options_;
    std::string said_;
    nlohmann::json report_;
};

// A scene that says which files its structures came from.
void write_scene_of_files(const std::filesystem::path& path) {
    sample::scene(sample::meta(), sample::structure(), sample::codebook(), sample::grid(),
                  "map: sample\nstructure: /a.pdb\nstructure check: 1 bytes, crc32 00000000\n")
        .write(path);
}

TEST_F(DeployRun, at_the_end_tact_prep_is_asked_to_save_the_last_places) {
    write_scene_of_files(scene_);
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    ASSERT_EQ(error_once_seen(), "");
    const auto poses = nlohmann::json::parse(read_small(options_.save / "poses.json"))["bodies"];
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_EQ(poses[0]["id"], 6);
    EXPECT_EQ(poses[0]["structure"], 0);
    EXPECT_EQ(poses[0]["name"], sample::structure().name);
    const Vec3 home_a = sample::structure().home_com_model_m * 1e10;
    EXPECT_NEAR(poses[0]["pos_model_a"][0].get<double>(), home_a.x() + 3.0, 1e-9);
    EXPECT_NEAR(poses[0]["pos_model_a"][2].get<double>(), home_a.z(), 1e-9);
    EXPECT_NEAR(poses[0]["quat_model_body_xyzw"][2].get<double>(), std::sqrt(0.5), 1e-12);
    EXPECT_EQ(read_small(options_.save / "asked.txt"), "export\n" + scene_.string() + "\n--poses\n" +
                                                           (options_.save / "poses.json").string() +
                                                           "\n-o\n" + options_.save.string() + "\n");
}

TEST_F(DeployRun, what_could_not_be_saved_is_said_before_the_run) {
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("made in code"), std::string::npos);
    write_scene_of_files(scene_);
    std::filesystem::create_directory(options_.save);
    std::ofstream(options_.save / "mine") << "x";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("never overwritten"),
              std::string::npos);
    options_.save = options_.save / "mine";
    EXPECT_NE(sample::error_of([&] { run_scene(scene_, options_); }).find("no folder"), std::string::npos);
}

TEST_F(DeployRun, a_save_that_fails_is_said_and_keeps_the_places) {
    misbehave("prep");
    write_scene_of_files(scene_);
    options_.gui = false;
    options_.save = scratch_.path() / "fit";
    const std::string error = error_once_seen();
    EXPECT_NE(error.find("exit code 5"), std::string::npos) << error;
    EXPECT_TRUE(std::filesystem::exists(options_.save / "poses.json"));
}

TEST_F(DeployRun, the_json_holds_what_the_controller_published) {
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
    EXPECT_EQ(servo["lateness_us"]["p999"], servo["lateness_us"]["p99"]);  // of 100 samples
    EXPECT_EQ(servo["lateness_us"]["max"], 50.0);
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

TEST_F(DeployRun, the_window_ends_the_run_and_its_picture_is_told) {
    options_.screenshot = scratch_.path() / "new" / "picture.png";
    ASSERT_EQ(run(), 0) << said_;
    EXPECT_TRUE(std::filesystem::exists(options_.screenshot));
    EXPECT_EQ(report_["ended"]["why"], "the time is over");
    EXPECT_EQ(report_["ended"]["tact-gui"]["exit_code"], 0);
}

TEST_F(DeployRun, out_collects_json_picture_and_samples) {
    options_.json.clear();
    options_.out = scratch_.path() / "all";
    ASSERT_EQ(run_until_seen(), 0) << said_;
    for (const char* const name : {"run.json", "run.csv", "run.png"})
        EXPECT_TRUE(std::filesystem::exists(scratch_.path() / "all" / name)) << name;
    const std::string csv = read_small(scratch_.path() / "all" / "run.csv");
    EXPECT_GE(std::count(csv.begin(), csv.end(), '\n'), 2);
    EXPECT_NE(csv.find(",active,999.00,"), std::string::npos);
}

TEST_F(DeployRun, a_controller_that_dies_ends_the_run_with_its_signal_told) {
    misbehave("crash");
    options_.gui = false;
    EXPECT_EQ(run_until_seen(), 1);
    EXPECT_FALSE(report_["ended"]["ok"].get<bool>());
    EXPECT_EQ(report_["ended"]["tact-rt"]["signal"], SIGSEGV);
    EXPECT_NE(said_.find("tact-rt was killed by signal 11"), std::string::npos) << said_;
    EXPECT_EQ(report_["force_rate_hz"], 998.5) << "what it had published stays readable";
}

TEST_F(DeployRun, a_controller_that_refuses_to_start_is_told_by_its_exit_code) {
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

TEST_F(DeployRun, a_controller_that_is_asked_before_it_can_heed_has_ended_in_order) {
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
    EXPECT_NE(said_.find("had not heeded"), std::string::npos) << said_;
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
    EXPECT_EQ(report_["ended"]["why"], "asked by Interrupt");
    EXPECT_EQ(report_["ended"]["tact-rt"]["exit_code"], 0);
}

TEST_F(DeployRun, a_controller_is_ended_by_the_kernel_where_tact_itself_is_killed) {
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
    const LinkServer other("default", region.fd());  // and is too busy to answer
    const std::string error = sample::error_of([&] { run_scene(scene_, options_); });
    EXPECT_NE(error.find("--session"), std::string::npos) << error;
}

TEST_F(DeployRun, a_socket_that_a_dead_controller_left_is_no_controller) {
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

TEST_F(DeployRun, a_picture_without_a_window_is_refused) {
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

int main(int argc, char** argv) {
    const std::string name = std::filesystem::path(argv[0]).filename();
    if (name == "tact-rt") return tact::launch::controller(argc, argv);
    if (name == "tact-gui") return tact::launch::window(argc, argv);
    if (name == "tact-prep") return tact::launch::prep(argc, argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
