// tact-gui as a process on an X server of its own: start, attach, levels, restart of the controller, screenshots.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>
#include <thread>

#include "deploy/tact/child.hpp"
#include "deploy/tact/x_server.hpp"
#include "ipc/image/png.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_window_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Long, because a loaded machine draws slowly under sanitizers; reached only by a failing test.
constexpr seconds kPatience(120);

template <class F>
bool wait_for(F&& happened) {
    const Instant until = Monotonic::now() + kPatience;
    while (Monotonic::now() < until) {
        if (happened()) return true;
        std::this_thread::sleep_for(milliseconds(2));
    }
    return false;
}

class Process {
public:
    // Output goes to the file. Descriptors above 2 stay open unless they are close-on-exec.
    Process(const std::vector<std::string>& command, const std::string& output) {
        pid_ = fork();
        if (pid_ != 0) return;
        const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        dup2(out, 1);
        dup2(out, 2);
        std::vector<char*> arguments;
        for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
        arguments.push_back(nullptr);
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    ~Process() {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    void signal(int number) const { kill(pid_, number); }
    bool running() {
        if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = 0;
        return pid_ > 0;
    }
    // The exit code, or 128 + signal; 999 if the process does not end.
    int wait() {
        if (!wait_for([&] { return !running(); })) return 999;
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    }

private:
    pid_t pid_ = 0;
    int status_ = 0;
};

class GuiWindow : public testing::Test {
protected:
    void SetUp() override {
        if (launch::find_in_path("Xvfb").empty())
            GTEST_SKIP() << "Xvfb is not installed: there is no display to draw on";
        char name[] = "/tmp/tact-gui-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        // Graphics drivers and X libraries deliberately keep memory until exit.
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
        x_server_ = std::make_unique<launch::XServer>(folder_, 800, 600);
        for (const auto& [key, value] : x_server_->environment())
            value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
    }
    void TearDown() override {
        x_server_.reset();
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }

    std::unique_ptr<Process> gui(std::vector<std::string> arguments, const char* size = "640x480") const {
        arguments.insert(arguments.begin(), {TACT_GUI_PROGRAM, "--session", "t", "--size", size});
        return std::make_unique<Process>(arguments, folder_ + "/gui.log");
    }
    std::string log(const std::string& name = "gui.log") const {
        std::ifstream file(folder_ + "/" + name);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::string scene() {
        const std::string path = folder_ + "/scene.tact";
        checksum_ = fake::write_helix_scene(path);
        vertices_ = read_mesh(SceneFile::open(path), 0).vertices();
        return path;
    }
    // Serves the link until the GUI has drawn the scene.
    bool drawing(fake::Controller& controller) {
        return wait_for([&] {
            LoadTopic load{};
            return controller.serve(1) && controller.gui()->load.read(load) && load.vertices_drawn > 0;
        });
    }
    static std::set<std::uint32_t> colours(const std::string& path, std::uint32_t width,
                                           std::uint32_t height) {
        if (!std::filesystem::exists(path)) return {};
        PngReader picture(path);
        EXPECT_EQ(picture.width_px(), width);
        EXPECT_EQ(picture.height_px(), height);
        const std::vector<std::uint8_t> rgb = picture.read(PngFormat::rgb);
        std::set<std::uint32_t> colours;
        for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
            colours.insert(static_cast<std::uint32_t>(rgb[i] | rgb[i + 1] << 8U | rgb[i + 2] << 16U));
        return colours;
    }

    // The colours of a window that has drawn a few frames while something was published.
    std::set<std::uint32_t> shown(fake::Controller& controller, const std::function<void()>& publish) {
        const std::string picture = folder_ + "/shown.png";
        const auto process = gui({"--screenshot", picture, "--hidden"});
        EXPECT_TRUE(drawing(controller)) << log();
        LoadTopic load{};
        if (controller.gui().empty() || !controller.gui()->load.read(load)) return {};
        const std::uint64_t before = load.frame;
        EXPECT_TRUE(wait_for([&] {
            publish();
            controller.serve(1);
            return controller.gui()->load.read(load) && load.frame > before + 5;
        })) << log();
        process->signal(SIGTERM);
        EXPECT_EQ(process->wait(), 0) << log();
        return colours(picture, 640, 480);
    }

    std::string folder_;
    std::unique_ptr<launch::XServer> x_server_;
    std::uint64_t checksum_ = 0;
    std::uint32_t vertices_ = 0;
};

TEST_F(GuiWindow, starts_without_a_controller_and_writes_the_screenshot_at_the_end) {
    const std::string picture = folder_ + "/alone.png";
    for (const bool hidden : {false, true}) {
        std::vector<std::string> arguments{scene(), "--seconds", "1", "--screenshot", picture};
        if (hidden) arguments.push_back("--hidden");
        EXPECT_EQ(gui(arguments)->wait(), 0) << log();
        EXPECT_GT(colours(picture, 640, 480).size(), 100U) << "hidden: " << hidden << "\n" << log();
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            EXPECT_NE(entry.path().extension(), ".partial");
        std::filesystem::remove(picture);
    }
}

TEST_F(GuiWindow, writes_the_frame_times_at_the_end) {
    const std::string report = folder_ + "/frames.json";
    EXPECT_EQ(gui({scene(), "--hidden", "--seconds", "1", "--frames", report})->wait(), 0) << log();
    std::ifstream file(report);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const char* const word :
         {"\"late\"", "\"surface\"", "\"gui.mesh\"", "\"drawn_ms\"", "\"resident_bytes\""})
        EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
    EXPECT_NE(gui({scene(), "--hidden", "--seconds", "0.2", "--frames", "/nowhere/f.json"})->wait(), 0);
    EXPECT_NE(log().find("--frames"), std::string::npos) << log();
}

TEST_F(GuiWindow, applies_the_appearance_options_of_the_command_line) {
    const std::string picture = folder_ + "/looks.png";
    EXPECT_EQ(
        gui({scene(), "--hidden", "--seconds", "1", "--screenshot", picture, "--molecule", "spheres",
             "--colour", "element", "--no-depth-cue", "--contour", "0.5", "--contour", "0.3:ff8000:0.5:wire"})
            ->wait(),
        0)
        << log();
    EXPECT_GT(colours(picture, 640, 480).size(), 100U) << log();
    EXPECT_NE(gui({scene(), "--contour", "half"})->wait(), 0);
    EXPECT_NE(log().find("half"), std::string::npos) << log();
    EXPECT_NE(gui({scene(), "--molecule", "ribbon"})->wait(), 0);
}

TEST_F(GuiWindow, the_frame_after_a_level_change_draws_that_many_vertices) {
    fake::Controller controller("t", scene(), checksum_);
    const auto process = gui({});
    ASSERT_TRUE(drawing(controller)) << log();
    for (const float level : {0.5F, 0.1F, 1.0F, 0.3F}) {
        const auto items = static_cast<std::uint32_t>(level * static_cast<float>(vertices_));
        LoadTopic load{};
        ASSERT_TRUE(controller.gui()->load.read(load));
        const std::uint64_t before = load.frame;
        controller.publish_level(kMeshPath, level, items, vertices_);
        ASSERT_TRUE(wait_for([&] {
            return controller.gui()->load.read(load) && load.levels_sequence == controller.levels_sequence();
        })) << log();
        EXPECT_EQ(load.vertices_drawn, items);
        EXPECT_EQ(load.vertices_max, vertices_);
        // The frame in progress may have read the level already; the next one must have the change.
        for (std::uint64_t frame = load.frame; frame < before + 3;) {
            ASSERT_TRUE(controller.gui()->load.read(load));
            if (load.frame == frame) continue;
            frame = load.frame;
            EXPECT_EQ(load.vertices_drawn, items);
        }
    }
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(), 0) << log();
}

TEST_F(GuiWindow, the_heartbeat_has_parts_and_processor_time) {
    fake::Controller controller("t", scene(), checksum_);
    const auto process = gui({"--fps-max", "0"});
    ASSERT_TRUE(drawing(controller)) << log();
    LoadTopic first{}, last{};
    ASSERT_TRUE(controller.gui()->load.read(first));
    ASSERT_TRUE(wait_for([&] { return controller.gui()->load.read(last) && last.frame >= first.frame + 5; }));
    EXPECT_GT(last.taken_at_ns, first.taken_at_ns);
    EXPECT_GT(last.cpu_s, first.cpu_s);
    EXPECT_GT(last.fps, 0.0);
    double sum = 0.0;
    for (const double part : last.part_s) {
        EXPECT_GE(part, 0.0);
        sum += part;
    }
    // Software rendering waits for no display: all of the time is work.
    EXPECT_NEAR(sum, last.busy_s, 1e-9);
    EXPECT_GT(last.triangles_drawn, 0U);
    FramesTopic frames{};
    ASSERT_TRUE(wait_for([&] {
        return controller.gui()->frames.read(frames) && frames.metrics.frames >= 2 * kFinishEvery &&
               frames.metrics.pass[static_cast<std::size_t>(Pass::surface)].work_p99_s > 0.0F;
    })) << log();
    const FrameMetrics& f = frames.metrics;
    EXPECT_TRUE(plausible(f));
    EXPECT_GT(f.gl_objects, 3U);
    EXPECT_GT(f.resident_bytes, 1000000U);
    EXPECT_GT(f.p50_s, 0.0F);
    for (const Pass pass : {Pass::ground, Pass::structures, Pass::surface, Pass::dashboard})
        EXPECT_GT(f.pass[static_cast<std::size_t>(pass)].drawn_p50_s, 0.0F) << pass_text(pass) << log();
    EXPECT_GT(f.path[0].drawn_p50_s, 0.0F);
    process->signal(SIGINT);
    EXPECT_EQ(process->wait(), 0) << log();
}

TEST_F(GuiWindow, garbage_in_the_region_is_ignored) {
    fake::Controller controller("t", scene(), checksum_);
    const auto process = gui({});
    ASSERT_TRUE(drawing(controller)) << log();
    BodiesTopic bodies;
    std::memset(&bodies, 0xFF, sizeof bodies);  // counts of four thousand million, poses that are NaN
    LevelsTopic levels;
    std::memset(&levels, 0xFF, sizeof levels);
    HealthTopic health;
    std::memset(static_cast<void*>(&health), 0xFF, sizeof health);
    ToolTopic tool;
    std::memset(&tool, 0xFF, sizeof tool);
    EventTopic event;
    std::memset(&event, 0xFF, sizeof event);
    LoadTopic load{};
    ASSERT_TRUE(controller.gui()->load.read(load));
    const std::uint64_t before = load.frame;
    while (load.frame < before + 20 && process->running()) {
        controller.region().bodies.publish(bodies);
        controller.region().levels.publish(levels);
        controller.region().health.publish(health);
        for (auto& hand : controller.region().tool) hand.publish(tool);
        controller.region().events.push(event);
        (void)controller.gui()->load.read(load);
        std::this_thread::sleep_for(milliseconds(1));
    }
    ASSERT_TRUE(process->running()) << log();
    controller.publish_level(kMeshPath, 0.25F, vertices_ / 4, vertices_);
    EXPECT_TRUE(
        wait_for([&] { return controller.gui()->load.read(load) && load.vertices_drawn == vertices_ / 4; }));
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(), 0) << log();
}

TEST_F(GuiWindow, a_second_hand_is_drawn_with_the_wall_it_touches) {
    fake::Controller controller("t", scene(), checksum_);
    std::vector<std::set<std::uint32_t>> pictures;
    for (const bool there : {false, true}) {
        ToolTopic tool{};
        tool.quat_world_tool_xyzw[3] = 1.0;
        tool.pos_world_m[0] = 0.02;
        tool.force_world_n[0] = -0.5;
        tool.at_wall = 1;
        pictures.push_back(shown(controller, [&] {
            tool.taken_at_ns = to_ns(Monotonic::now());
            if (there) controller.region().tool[1].publish(tool);
        }));
    }
    // Violet in any light; nothing else in the image is violet.
    const auto violet = [](const std::set<std::uint32_t>& seen) {
        return std::count_if(seen.begin(), seen.end(), [](std::uint32_t c) {
            const auto r = static_cast<int>(c & 255U), g = static_cast<int>(c >> 8 & 255U),
                       b = static_cast<int>(c >> 16 & 255U);
            return b > r + 25 && r > g + 15;
        });
    };
    EXPECT_GT(pictures[0].size(), 100U);
    EXPECT_EQ(violet(pictures[0]), 0);
    EXPECT_GT(violet(pictures[1]), 5);
}

TEST_F(GuiWindow, an_emergency_stop_is_shown_in_a_banner) {
    fake::Controller controller("t", scene(), checksum_);
    std::vector<std::set<std::uint32_t>> pictures;
    for (const bool pressed : {false, true}) {
        HealthTopic health{};
        health.period_ns = 1'000'000;
        health.goal_hz = health.force_rate_hz = 1000.0;
        health.state = static_cast<std::uint8_t>(pressed ? RunState::fault : RunState::active);
        health.lines = static_cast<std::uint8_t>(pressed ? LinesShown::stopped : LinesShown::permitted);
        health.lines_reason = static_cast<std::uint8_t>(RunReason::emergency_stop);
        pictures.push_back(shown(controller, [&] {
            health.taken_at_ns = to_ns(Monotonic::now());
            controller.region().health.publish(health);
        }));
    }
    // The background of the banner.
    const auto dark_red = [](const std::set<std::uint32_t>& seen) {
        return std::count_if(seen.begin(), seen.end(), [](std::uint32_t c) {
            const auto r = static_cast<int>(c & 255U), g = static_cast<int>(c >> 8 & 255U),
                       b = static_cast<int>(c >> 16 & 255U);
            return r > 80 && r < 110 && g < 40 && b < 40;
        });
    };
    EXPECT_GT(pictures[0].size(), 100U);
    EXPECT_EQ(dark_red(pictures[0]), 0);
    EXPECT_GT(dark_red(pictures[1]), 0);
}

// Mouse input from the X server to the exported file.
TEST_F(GuiWindow, the_mouse_pauses_the_traces_and_exports_them) {
    if (launch::find_in_path("xdotool").empty())
        GTEST_SKIP() << "xdotool is not installed: the mouse cannot be moved";
    x_server_ = std::make_unique<launch::XServer>(folder_, 1280, 720);
    for (const auto& [key, value] : x_server_->environment())
        value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
    fake::Controller controller("t", scene(), checksum_);
    setenv("TACT_OUTPUT", folder_.c_str(), 1);
    const auto process = gui({"--traces"}, "1280x720");
    ASSERT_TRUE(drawing(controller)) << log();
    std::uint64_t cycle = 0;
    const auto live = [&](int milliseconds_long) {
        for (int i = 0; i < milliseconds_long; ++i) {
            TraceTopic t{};
            t.taken_at_ns = to_ns(Monotonic::now());
            t.cycle = ++cycle;
            t.force_world_n[1] = static_cast<float>(cycle % 100) * 0.01F;
            controller.region().trace.push(t);
            controller.serve(0);
            std::this_thread::sleep_for(milliseconds(1));
        }
    };
    live(300);
    const auto exported = [&] {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            if (entry.path().extension() == ".csv") files.push_back(entry.path());
        return files;
    };
    const auto mouse = [&](const std::string& what) {
        EXPECT_EQ(std::system(("xdotool " + what).c_str()), 0) << what;
        live(100);
    };
    mouse("search --onlyvisible --name Tact windowfocus");
    mouse("mousemove 356 398");
    mouse("click 1");  // Pause
    // The position of the button depends on the fonts: the test clicks along the row until a file appears.
    for (int x = 900; x > 560 && exported().empty(); x -= 20) {
        mouse("mousemove " + std::to_string(x) + " 398");
        mouse("mousedown 1");
        mouse("mouseup 1");
    }
    ASSERT_TRUE(wait_for([&] { return !exported().empty(); })) << log();
    const std::uint64_t newest = cycle;
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(), 0) << log();
    std::ifstream file(exported().front());
    std::string line, last;
    std::getline(file, line);
    EXPECT_EQ(line.rfind("time_s,taken_at_ns,cycle,state", 0), 0U) << line;
    std::size_t lines = 0;
    for (; std::getline(file, line); ++lines) last = line;
    EXPECT_GT(lines, 100U);
    // Held since Pause was pressed: later cycles are not in the file.
    std::uint64_t cycle_of_last = 0;
    ASSERT_EQ(std::sscanf(last.c_str(), "%*[^,],%*[^,],%lu,", &cycle_of_last), 1) << last;
    EXPECT_LT(cycle_of_last + 100, newest);
}

TEST_F(GuiWindow, survives_a_restart_of_the_controller_and_attaches_again) {
    const std::string path = scene();
    auto controller = std::make_unique<fake::Controller>("t", path, checksum_);
    const auto process = gui({});
    ASSERT_TRUE(drawing(*controller)) << log();
    for (int round = 0; round < 3; ++round) {
        controller.reset();
        controller = std::make_unique<fake::Controller>("t", path, checksum_);
        ASSERT_TRUE(drawing(*controller)) << log();
        controller->publish_level(kMeshPath, 0.4F, vertices_ / 3 + static_cast<std::uint32_t>(round),
                                  vertices_);
        LoadTopic load{};
        EXPECT_TRUE(wait_for([&] {
            return controller->gui()->load.read(load) &&
                   load.vertices_drawn == vertices_ / 3 + static_cast<std::uint32_t>(round);
        })) << log();
    }
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(), 0) << log();
}

TEST_F(GuiWindow, a_broken_scene_is_reported_and_the_window_stays_open) {
    const std::string path = folder_ + "/broken.tact";
    std::ofstream(path) << "this is not a scene";
    EXPECT_EQ(gui({path, "--seconds", "1", "--screenshot", folder_ + "/broken.png"})->wait(), 0) << log();
    EXPECT_NE(log().find("fix:"), std::string::npos) << log();
    EXPECT_GT(colours(folder_ + "/broken.png", 640, 480).size(), 20U);
}

TEST_F(GuiWindow, a_missing_display_is_reported_with_a_fix) {
    unsetenv("DISPLAY");
    EXPECT_EQ(gui({"--seconds", "1"})->wait(), 1);
    EXPECT_NE(log().find("no display"), std::string::npos) << log();
    EXPECT_NE(log().find("fix:"), std::string::npos) << log();
    setenv("WAYLAND_DISPLAY", "wayland-0", 1);
    EXPECT_EQ(gui({"--seconds", "1"})->wait(), 1);
    EXPECT_NE(log().find("install the package xwayland"), std::string::npos) << log();
    unsetenv("WAYLAND_DISPLAY");
}

TEST_F(GuiWindow, a_series_of_screenshots_is_written) {
    const std::string picture = folder_ + "/series.png";
    EXPECT_EQ(gui({scene(), "--hidden", "--seconds", "1.2", "--screenshot", picture, "--picture-every", "0.4",
                   "--zoom", "2"})
                  ->wait(),
              0)
        << log();
    EXPECT_TRUE(std::filesystem::exists(picture));
    for (const char* const each : {"/series-01.png", "/series-02.png"})
        EXPECT_TRUE(std::filesystem::exists(folder_ + each)) << each << log();
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/series-09.png"));
}

TEST_F(GuiWindow, every_stereo_mode_draws_two_eyes_in_the_view_or_in_separate_windows) {
    const std::string window = folder_ + "/window.png", picture = folder_ + "/stereo.png",
                      file = folder_ + "/stage.toml";
    for (const char* const mode : {"anaglyph", "side-by-side", "top-bottom"}) {
        EXPECT_EQ(gui({scene(), "--hidden", "--seconds", "0.6", "--stereo", mode, "--screenshot", window,
                       "--stage-screenshot", picture})
                      ->wait(),
                  0)
            << log();
        EXPECT_GT(colours(window, 640, 480).size(), 100U) << mode;
        EXPECT_TRUE(std::filesystem::remove(picture)) << mode << log();
    }
    // Visible windows, and no screenshot of the dashboard.
    std::ofstream(file) << "monitors = [0]\n";
    EXPECT_EQ(gui({scene(), "--seconds", "0.6", "--stage", file, "--stereo", "side-by-side",
                   "--stage-screenshot", picture})
                  ->wait(),
              0)
        << log();
    EXPECT_GT(colours(picture, 800, 600).size(), 100U) << log();  // the X server's only monitor
    std::ofstream(file) << "mode = \"two-windows\"\nsize_px = [500, 400]\nplace = \"workspace\"\n";
    EXPECT_EQ(gui({scene(), "--seconds", "0.6", "--stage", file, "--stage-screenshot", picture})->wait(), 0)
        << log();
    const std::string left = folder_ + "/stereo-left.png", right = folder_ + "/stereo-right.png";
    EXPECT_GT(colours(left, 500, 400).size(), 50U);
    EXPECT_GT(colours(right, 500, 400).size(), 50U);
    const auto bytes = [](const std::string& path) {
        std::ifstream in(path, std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(in), {}};
    };
    EXPECT_NE(bytes(left), bytes(right));
}

TEST_F(GuiWindow, an_impossible_stage_is_refused_with_a_reason) {
    const std::string file = folder_ + "/stage.toml";
    std::ofstream(file) << "monitors = [7]\nmode = \"anaglyph\"\n";
    EXPECT_EQ(gui({"--seconds", "0.5", "--stage", file})->wait(), 1);
    EXPECT_NE(log().find("no monitor 7"), std::string::npos) << log();
    std::ofstream(file) << "mode = \"sideways\"\n";
    EXPECT_EQ(gui({"--seconds", "0.5", "--stage", file})->wait(), 2);
    EXPECT_NE(log().find("sideways"), std::string::npos) << log();
    EXPECT_NE(gui({"--stereo", "sideways"})->wait(), 0);
}

TEST_F(GuiWindow, stereo_that_the_driver_refuses_leaves_one_image_and_a_message_in_the_window) {
    // Software renderers have no buffers for two eyes.
    const std::string picture = folder_ + "/mono.png", texts = folder_ + "/texts.json";
    EXPECT_EQ(
        gui({scene(), "--seconds", "1", "--stereo", "quad-buffer", "--screenshot", picture, "--texts", texts})
            ->wait(),
        0)
        << log();
    EXPECT_NE(log().find("no quad-buffered stereo"), std::string::npos) << log();
    EXPECT_GT(colours(picture, 640, 480).size(), 100U);
    std::ifstream in(texts);
    const std::string shown{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(shown.find("Stereo is off, because"), std::string::npos) << shown;
    EXPECT_NE(shown.find("side-by-side"), std::string::npos) << shown;
    // What was to be saved of it is missing, which is an error.
    EXPECT_EQ(
        gui({scene(), "--seconds", "0.5", "--stereo", "quad-buffer", "--stage-screenshot", picture})->wait(),
        1)
        << log();
}

TEST_F(GuiWindow, an_unwritable_screenshot_is_an_error_and_arguments_are_checked) {
    EXPECT_EQ(gui({"--seconds", "0.5", "--screenshot", folder_ + "/none/such.png"})->wait(), 1);
    EXPECT_NE(log().find("such.png"), std::string::npos) << log();
    EXPECT_NE(gui({"--size", "5x5"})->wait(), 0);
    EXPECT_NE(gui({"--nonsense"})->wait(), 0);
    EXPECT_NE(gui({"--session", "../../etc"})->wait(), 0);
}

}  // namespace
}  // namespace tact::gui_window_test
