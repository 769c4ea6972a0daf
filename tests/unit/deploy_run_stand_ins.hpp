// Whole runs of the launcher with substitutes for the programs: the test itself under the names tact-rt, tact-gui and
// tact-prep. The substitute for the controller publishes a real region with known numbers; the substitute for the
// window starts its time when the controller is up; MISBEHAVE selects how they end.
//
// Such a test ends with int main(int argc, char** argv) { return tact::launch::play(argc, argv); }
#pragma once

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
#include "deploy/tact/run.hpp"
#include "ipc/base/device_notice.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::launch {

inline volatile sig_atomic_t asked_to_end = 0;

inline std::string value_of(int argc, char** argv, const std::string& option) {
    for (int i = 1; i + 1 < argc; ++i)
        if (argv[i] == option) return argv[i + 1];
    return "";
}

inline std::string misbehaviour() {
    const char* const m = std::getenv("MISBEHAVE");
    return m != nullptr ? m : "";
}

// Writes one line to the file named by the environment variable.
inline void log_words(const char* variable, int argc, char** argv) {
    const char* const log = std::getenv(variable);
    if (log == nullptr) return;
    std::ofstream told(log, std::ios::app);
    for (int i = 1; i < argc; ++i) told << argv[i] << (i + 1 < argc ? ' ' : '\n');
}

inline void fill(RtRegion& region, std::uint64_t cycle, double off_m = 3e-10) {
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
    h.device_notice[0] = static_cast<std::uint8_t>(DeviceNotice::states_refused);
    h.device_bus[0] = {.packets = 1000, .checksum = 3, .reconnects = 1};
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
    // By default 3 A off, and rotated by 90 degrees about z.
    BodiesTopic bodies{};
    bodies.count = 1;
    const Vec3 home = sample::structure().home_com_model_m;
    bodies.body[0] = {
        {home.x() + off_m, home.y(), home.z()}, {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}, 6, 0, kBodyFixed};
    region.bodies.publish(bodies);
}

inline int controller(int argc, char** argv) {
    if (misbehaviour() == "ignore") {
        signal(SIGTERM, SIG_IGN);
    } else if (misbehaviour() != "early") {
        struct sigaction action {};
        action.sa_handler = [](int) { asked_to_end = 1; };
        sigaction(SIGTERM, &action, nullptr);
    }
    if (misbehaviour() == "refuse") return 3;
    if (misbehaviour() == "refuse-other" && std::strcmp(argv[1], std::getenv("ASKS_FOR")) == 0) return 3;
    log_words("CONTROLLERS", argc, argv);
    OwnedRegion<RtRegion> region;
    std::strcpy(region->scene_path, argv[1]);
    region->scene_checksum = 0xABCD;
    fill(*region, 0);  // a region that is found is never empty
    region.mark_ready();
    LinkServer link(value_of(argc, argv, "--session"), region.fd());
    const Instant start = Monotonic::now();
    std::uint64_t cycle = 1;
    for (; asked_to_end == 0; ++cycle) {
        link.poll(5);
        fill(*region, cycle);
        const char* const life_s = std::getenv("LIFE_S");
        if (misbehaviour() == "crash" && to_s(Monotonic::now() - start) > std::atof(life_s)) {
            signal(SIGSEGV, SIG_DFL);  // a sanitizer would turn it into an exit code
            raise(SIGSEGV);
        }
    }
    fill(*region, cycle, misbehaviour() == "moves at the end" ? 5e-10 : 3e-10);
    return 0;
}

// Writes its window state file, runs for --seconds from the start of the controller, writes its screenshot and ends.
inline int window(int argc, char** argv) {
    log_words("WINDOWS", argc, argv);
    if (const std::string state = value_of(argc, argv, "--window-state"); !state.empty())
        std::ofstream(state) << "as left";
    LinkClient link(value_of(argc, argv, "--session"), -1);
    while (!link.attached()) {
        link.poll();
        ::poll(nullptr, 0, 2);
    }
    const std::string seconds = value_of(argc, argv, "--seconds");
    if (const char* const other = std::getenv("ASKS_FOR"); other != nullptr) {
        const std::filesystem::path folder = value_of(argc, argv, "--scene-switch");
        const bool before = std::filesystem::exists(std::getenv("TOLD"));
        std::ofstream told(std::getenv("TOLD"), std::ios::app);
        told << argv[1] << '\n';
        if (auto refusal = take_refusal(folder)) {
            told << *refusal << std::endl;
            return 0;  // the person closes the window
        }
        const bool bone = std::filesystem::path(other).extension() == ".bone";  // the scene stays
        if (bone ? !before : std::strcmp(argv[1], other) != 0) {
            const char* const as = std::getenv("ASKS_AS");  // its session
            if (const char* const back = std::getenv("GOES_BACK_TO"); back != nullptr)
                std::filesystem::copy_file(back, folder / kShownSession,
                                           std::filesystem::copy_options::overwrite_existing);
            ask_for_scene(folder, as != nullptr ? as : other);
            told << std::flush;
            for (;;) {
                ::poll(nullptr, 0, 5);
                if (auto refusal = take_refusal(folder)) {
                    told << *refusal << std::endl;
                    return 0;
                }
            }
        }
        return 0;
    }
    if (misbehaviour() == "window") return 4;
    ::poll(nullptr, 0, seconds.empty() ? 600'000 : static_cast<int>(std::stod(seconds) * 1000));
    if (const auto picture = value_of(argc, argv, "--screenshot"); !picture.empty())
        std::ofstream(picture) << "PNG";
    return 0;
}

// Writes its arguments into the output folder.
inline int prep(int argc, char** argv) {
    if (misbehaviour() == "prep") return 5;
    if (misbehaviour() == "prep-interrupted") {  // works forever; the person interrupts it
        kill(getppid(), SIGINT);
        for (;;) pause();
    }
    std::ofstream said(value_of(argc, argv, "-o") + "/asked.txt");
    for (int i = 1; i < argc; ++i) said << argv[i] << '\n';
    return 0;
}

class DeployRun : public testing::Test {
protected:
    void SetUp() override {
        setenv("TACT_RUNTIME_DIR", scratch_.path().c_str(), 1);
        setenv("DISPLAY", ":0", 0);  // the substitute opens no window
        const auto self = std::filesystem::read_symlink("/proc/self/exe");
        for (const char* const name : {"tact-rt", "tact-gui", "tact-prep"})
            std::filesystem::create_symlink(self, scratch_.path() / name);
        scene_ = scratch_.path() / "sample.tact";
        sample::scene().write(scene_);
        options_.programs = scratch_.path();
        options_.no_flight = true;  // there is no substitute for tact-record
        options_.json = scratch_.path() / "out" / "run.json";
        options_.seconds = 0.3;
        options_.grace = std::chrono::minutes(1);  // a busy machine must not look like a hang
    }
    void TearDown() override {
        for (const char* const name : {"MISBEHAVE", "ASKS_FOR", "TOLD", "CONTROLLERS", "WINDOWS"})
            unsetenv(name);
    }
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

    // If the machine paused, tact may not have read the controller in such a short run; then runs
    // longer.
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

    // The same for a run with --save, which ends with an error if the controller was not read.
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

// Runs the tests, or the program whose name this executable has.
inline int play(int argc, char** argv) {
    const std::string name = std::filesystem::path(argv[0]).filename();
    if (name == "tact-rt") return controller(argc, argv);
    if (name == "tact-gui") return window(argc, argv);
    if (name == "tact-prep") return prep(argc, argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

}  // namespace tact::launch
