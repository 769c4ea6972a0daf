// A complete calibration in a window on a separate X server, with keys and clicks, the emulated tracker (noise, frames,
// filter) and the emulated arm. The result must match the geometry of the test laboratory.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <mutex>
#include <thread>

#include "deploy/tact/child.hpp"
#include "deploy/tact/x_server.hpp"
#include "gui/stereo/calibration.hpp"
#include "hal/sim/sim_device.hpp"
#include "hal/sim/sim_tracker.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"
#include "rt/threads/head_feed.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_calibration_window_test {
namespace {

constexpr double kWidthM = 0.44, kHeightM = 0.34;
const Pose kScreenGlass{Vec3(0.05, -0.06, 0.42), quat_from_rotation_vector(Vec3(-0.2, 0.1, 0.03))};
// Some of the marks are out of the arm's reach.
const Pose kScreenWorld{Vec3(0.05, -0.06, 0.42), quat_from_rotation_vector(Vec3(-0.15, 0.05, 0.08))};

Vec3 mark_m(std::size_t i) {
    return kScreenGlass *
           Vec3((kMarkPlaces[i][0] - 0.5) * kWidthM, (kMarkPlaces[i][1] - 0.5) * kHeightM, 0.0);
}

// A controller with emulated devices that publishes the same topics as tact-rt.
class Laboratory {
public:
    Laboratory() {
        auto tracker = std::make_unique<SimTracker>();
        tracker_ = tracker.get();
        feed_ =
            std::make_unique<HeadFeed>(HeadSettings{}, std::move(tracker), region_->head, region_->tracker);
        feed_->open();
        arm_.open();
        region_.mark_ready();
        server_ = std::make_unique<LinkServer>("t", region_.fd());
    }
    [[nodiscard]] bool attached() const { return attached_.load(); }
    void hold_wand(const Vec3& at_m) { tracker_->hold(at_m); }
    void hold_stylus(const Vec3& at_world_m) {
        const std::lock_guard lock(mutex_);
        arm_.hold(at_world_m);
    }
    // Runs on its own thread, like a separate controller process, so the window always gets poses.
    void run() {
        thread_ = std::jthread([this](const std::stop_token& over) {
            while (!over.stop_requested()) {
                step();
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
        });
    }

private:
    void step() {
        const std::lock_guard lock(mutex_);
        LinkServer::News news = server_->poll(0);
        if (news.gui_arrived) {
            std::string refusal;
            gui_ = MappedRegion<GuiRegion>::map(std::move(news.gui_fd), refusal);
            attached_.store(!gui_.empty());
        }
        const Instant now = Monotonic::now();
        feed_->step(now);
        DeviceSample sample;
        static_cast<void>(arm_.read(sample, now));
        ToolTopic tool{};
        tool.taken_at_ns = to_ns(now);
        for (int i = 0; i < 3; ++i) tool.pos_world_m[i] = sample.T_dev_tool.p_m[i];
        for (int i = 0; i < 4; ++i) tool.quat_world_tool_xyzw[i] = sample.T_dev_tool.q.coeffs()[i];
        tool.device_state = static_cast<std::uint8_t>(DeviceState::ready);
        region_->tool[0].publish(tool);
    }

    OwnedRegion<RtRegion> region_;
    SimTracker* tracker_ = nullptr;
    std::unique_ptr<HeadFeed> feed_;
    SimDevice arm_{SimSettings{}};
    std::unique_ptr<LinkServer> server_;
    MappedRegion<GuiRegion> gui_;
    std::atomic<bool> attached_{false};
    std::mutex mutex_;  // protects the arm
    std::jthread thread_;
};

class CalibrationWindow : public testing::Test {
protected:
    void SetUp() override {
        for (const char* const program : {"Xvfb", "xdotool"})
            if (launch::find_in_path(program).empty())
                GTEST_SKIP() << program << " is not installed: keys cannot be sent";
        char name[] = "/tmp/tact-calibration-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        // Graphics drivers and X libraries keep memory until exit on purpose.
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
        x_server_ = std::make_unique<launch::XServer>(folder_, 1024, 720);
        for (const auto& [key, value] : x_server_->environment())
            value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
        laboratory_ = std::make_unique<Laboratory>();
    }
    void TearDown() override {
        gui_.reset();
        laboratory_.reset();
        x_server_.reset();
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }
    void start(std::vector<std::string> arguments) {
        const int out = open((folder_ + "/gui.log").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        launch::ChildSettings settings;
        settings.arguments = {"--session", "t", "--size", "1000x700"};
        settings.arguments.insert(settings.arguments.end(), arguments.begin(), arguments.end());
        settings.output_fd = out;
        gui_ = std::make_unique<launch::Child>("tact-gui", TACT_GUI_PROGRAM, settings);
        close(out);
    }
    [[nodiscard]] std::string log() const {
        std::ifstream file(folder_ + "/gui.log");
        return {std::istreambuf_iterator<char>(file), {}};
    }
    // Waits until the log contains `words` `times` times.
    [[nodiscard]] bool logged(const std::string& words, std::size_t times = 1) {
        return test::wait_for([&] {
                   const std::string text = log();
                   std::size_t count = 0;
                   for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at) ++count;
                   return count >= times || gui_->poll();
               }) &&
               !gui_->poll();
    }
    static void xdotool(const std::string& what) {
        EXPECT_EQ(std::system(("xdotool " + what).c_str()), 0) << what;
    }
    static void press(const std::string& key) { xdotool("key " + key); }
    static void click(int x_px, int y_px) {
        xdotool("mousemove " + std::to_string(x_px) + " " + std::to_string(y_px) + " sleep 0.3 click 1");
    }

    std::string folder_;
    std::unique_ptr<launch::XServer> x_server_;
    std::unique_ptr<Laboratory> laboratory_;
    std::unique_ptr<launch::Child> gui_;
};

TEST_F(CalibrationWindow, completes_with_emulated_devices_from_the_first_key_to_the_file) {
    const std::string file = folder_ + "/lab.toml";
    // The display size from a ruler; its pose is unknown.
    std::ofstream(file)
        << "[screen]\nlower_left_m = [-0.22, -0.17, 0.0]\nlower_right_m = [0.22, -0.17, 0.0]\n"
           "upper_left_m = [-0.22, 0.17, 0.0]\n";
    start({"--stage", file});
    laboratory_->run();
    ASSERT_TRUE(test::wait_for([&] { return laboratory_->attached(); })) << log();
    laboratory_->hold_wand(mark_m(0));
    press("k");
    ASSERT_TRUE(logged("calibration: started")) << log();
    press("Return");
    press("Return");
    ASSERT_TRUE(logged("step 3, Screen")) << log();
    for (std::size_t i = 0; i < kMarks; ++i) {
        // The third mark is first measured 3 cm off.
        laboratory_->hold_wand(mark_m(i) + (i == 2 ? Vec3(0.03, 0.0, 0.01) : Vec3(Vec3::Zero())));
        press("t");
        ASSERT_TRUE(logged("Point " + std::to_string(i + 1) + " measured")) << log();
    }
    press("Return");
    ASSERT_TRUE(logged("Point 3 does not fit the others: measure it again")) << log();
    press("Escape");
    ASSERT_TRUE(logged("calibration: closed")) << log();
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/stage.toml"));

    press("k");
    ASSERT_TRUE(logged("calibration: started", 2)) << log();
    press("Return");
    press("Return");
    ASSERT_TRUE(logged("step 3, Screen", 2)) << log();
    for (std::size_t i = 0; i < kMarks; ++i) {
        laboratory_->hold_wand(mark_m(i));
        press("t");
        ASSERT_TRUE(logged("Point " + std::to_string(i + 1) + " measured", 2)) << log();
    }
    press("b");  // repeat the last point
    ASSERT_TRUE(logged("Point 6 will be measured again")) << log();
    press("t");
    ASSERT_TRUE(logged("Point 6 measured", 3)) << log();
    press("Return");
    ASSERT_TRUE(logged("calibration: Screen: green")) << log();
    ASSERT_TRUE(logged("step 4, Workspace")) << log();

    // Measure the marks within the arm's reach with the stylus.
    std::size_t taken = 0;
    for (std::size_t i = 0; i < kMarks; ++i) {
        const Vec3 at_world_m = kScreenWorld.inverse() * mark_m(i);
        if (std::abs(at_world_m.x()) > 0.205 || std::abs(at_world_m.y()) > 0.14 ||
            std::abs(at_world_m.z()) > 0.1) {
            press("n");
            continue;
        }
        laboratory_->hold_stylus(at_world_m);
        press("t");
        ASSERT_TRUE(logged("Point " + std::to_string(i + 1) + " measured", i == 5 ? 4 : 3)) << log();
        ++taken;
    }
    ASSERT_GE(taken, kMarksMin);
    press("Return");
    ASSERT_TRUE(logged("calibration: Workspace: green")) << log();
    press("x");
    press("Return");
    ASSERT_TRUE(logged("step 6, Check")) << log();
    press("ctrl+s");
    ASSERT_TRUE(logged("and read back")) << log();
    press("Escape");
    ASSERT_TRUE(logged("calibration: closed", 2)) << log();

    const StageSettings found = read_stage_file(file);
    const ScreenPlace flat = ScreenPlace::of_size(kWidthM, kHeightM);
    EXPECT_LT((found.screen.lower_left_m - kScreenGlass * flat.lower_left_m).norm(), 2e-3);
    EXPECT_LT((found.screen.lower_right_m - kScreenGlass * flat.lower_right_m).norm(), 2e-3);
    EXPECT_LT((found.screen.upper_left_m - kScreenGlass * flat.upper_left_m).norm(), 2e-3);
    for (const Vec3& corner : {Vec3(0.15, 0.1, 0.05), Vec3(-0.15, -0.1, -0.05)})
        EXPECT_LT((found.T_screen_world * corner - kScreenWorld * corner).norm(), 4e-3);
    EXPECT_TRUE(found.in_workspace);
    EXPECT_TRUE(found.eyes.swapped);
    EXPECT_EQ(found.mode, StereoMode::anaglyph);
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("# screen point 1: "), std::string::npos) << text;
    std::size_t old = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        old += entry.path().extension() == ".old";
    EXPECT_EQ(old, 1U);
    gui_->stop();
    const auto ending = gui_->wait(std::chrono::seconds(60));
    ASSERT_TRUE(ending);
    EXPECT_TRUE(ending->clean()) << ending->text() << log();
}

}  // namespace
}  // namespace tact::gui_calibration_window_test
