// Keys pressed on an X server, through the window, to their effects: commands to the controller and the log.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "deploy/tact/child.hpp"
#include "deploy/tact/x_server.hpp"
#include "gui/system/keys.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_keys_window_test {
namespace {

using std::chrono::milliseconds;
constexpr std::chrono::seconds kPatience(60);  // reached only on failure

class KeysInTheWindow : public testing::Test {
protected:
    void SetUp() override {
        for (const char* const program : {"Xvfb", "xdotool"})
            if (launch::find_in_path(program).empty())
                GTEST_SKIP() << program << " is not installed: keys cannot be sent";
        char name[] = "/tmp/tact-keys-test-XXXXXX";
        folder_ = mkdtemp(name);
        setenv("TACT_RUNTIME_DIR", folder_.c_str(), 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("TACT_OUTPUT", folder_.c_str(), 1);
        setenv("SPDLOG_LEVEL", "debug", 1);
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // graphics drivers keep memory until exit on purpose
        x_server_ = std::make_unique<launch::XServer>(folder_, 800, 600);
        for (const auto& [key, value] : x_server_->environment())
            value.empty() ? unsetenv(key.c_str()) : setenv(key.c_str(), value.c_str(), 1);
        const std::string scene = folder_ + "/scene.tact";
        const std::uint64_t checksum = fake::write_helix_scene(scene);
        controller_ = std::make_unique<fake::Controller>("t", scene, checksum);
        const std::string log = folder_ + "/gui.log";
        gui_ = fork();
        if (gui_ == 0) {
            if (chdir(folder_.c_str()) != 0 || freopen(log.c_str(), "w", stderr) == nullptr) _exit(126);
            execl(TACT_GUI_PROGRAM, TACT_GUI_PROGRAM, "--session", "t", "--size", "640x480", "--stereo",
                  stereo_, nullptr);
            _exit(127);
        }
        ASSERT_TRUE(wait_for([&] {
            LoadTopic load{};
            return controller_->gui()->load.read(load) && load.vertices_drawn > 0;
        })) << log_text();
        // There is no window manager to give the window the keyboard focus.
        ASSERT_EQ(std::system("xdotool search --sync --name '^Tact' windowfocus --sync >/dev/null 2>&1"), 0);
    }
    void TearDown() override {
        if (gui_ > 0) {
            kill(gui_, SIGTERM);
            waitpid(gui_, nullptr, 0);
        }
        x_server_.reset();
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }

    template <class F>
    bool wait_for(F&& happened) {
        const Instant until = Monotonic::now() + kPatience;
        while (Monotonic::now() < until) {
            if (controller_->serve(1) && happened()) return true;
            std::this_thread::sleep_for(milliseconds(2));
        }
        return false;
    }
    static void press(const std::string& key) {
        ASSERT_EQ(std::system(("xdotool key --clearmodifiers " + key).c_str()), 0) << key;
    }
    std::string log_text() const {
        std::ifstream file(folder_ + "/gui.log");
        return {std::istreambuf_iterator<char>(file), {}};
    }
    bool logged(const KeyRow& row) {
        const std::string line = std::string("key ") + row.keys + ": " + row.what + "\n";
        return wait_for([&] { return log_text().find(line) != std::string::npos; });
    }
    bool commanded(CommandKind kind) {
        return wait_for([&] {
            CommandTopic command{};
            while (controller_->gui()->commands.next(commands_place_, command))
                if (command.kind == static_cast<std::uint16_t>(kind)) {
                    last_ = command;
                    return true;
                }
            return false;
        });
    }
    void be(RunState run, const CommandTopic* answered) {
        HealthTopic health{};
        health.taken_at_ns = to_ns(Monotonic::now());
        health.period_ns = 1'000'000;
        health.goal_hz = health.force_rate_hz = 1000.0;
        health.state = static_cast<std::uint8_t>(run);
        if (answered != nullptr) {
            health.command_sequence = answered->sequence;
            health.command_result = static_cast<std::uint32_t>(CommandResult::done);
        }
        controller_->region().health.publish(health);
    }

    const char* stereo_ = "anaglyph";
    std::string folder_;
    std::unique_ptr<launch::XServer> x_server_;
    std::unique_ptr<fake::Controller> controller_;
    pid_t gui_ = 0;
    CommandQueue::Cursor commands_place_;
    CommandTopic last_{};
};

std::string name_for_x(const KeyStroke& stroke) {
    std::string name = stroke.control ? "ctrl+" : "";
    if (stroke.shift) name += "shift+";
    switch (stroke.code) {
        case KeyCode::home:
            return name + "Home";
        case KeyCode::enter:
            return name + "Return";
        case KeyCode::escape:
            return name + "Escape";
        case KeyCode::space:
            return name + "space";
        default:
            break;
    }
    switch (stroke.character) {
        case '+':
            return name + "plus";
        case '-':
            return name + "minus";
        case '?':
            return name + "question";
        default:
            return name + stroke.character;
    }
}

TEST_F(KeysInTheWindow, every_key_of_a_docking_scene_is_handled) {
    const KeySituation now{.sheet = false, .bodies = true, .bone = false, .stereo = true, .controller = true};
    const KeyRow* close = nullptr;
    std::size_t pressed = 0;
    for (const KeyRow& row : key_rows()) {
        if (row.when == KeyWhen::sheet) close = &row;
        if (row.action == KeyAction::none || !applies(row.when, now)) continue;
        press(name_for_x(row.stroke));
        EXPECT_TRUE(logged(row)) << row.keys << "\n" << log_text();
        ++pressed;
    }
    EXPECT_GT(pressed, 15U);
    // `?` was last, so its sheet is open.
    ASSERT_NE(close, nullptr);
    press(name_for_x(close->stroke));
    EXPECT_TRUE(logged(*close)) << log_text();
    EXPECT_TRUE(wait_for([&] {
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            if (entry.path().extension() == ".png") return true;
        return false;
    })) << "P saved no image\n"
        << log_text();
}

TEST_F(KeysInTheWindow, arm_is_sent_only_from_ready_and_disarm_always) {
    be(RunState::off, nullptr);
    press("ctrl+Return");
    press("m");
    ASSERT_TRUE(commanded(CommandKind::mark)) << log_text();
    EXPECT_EQ(last_.sequence, 1U) << "arm was sent although the controller was off";
    be(RunState::ready, nullptr);
    // The window may not have read the state yet, so press until it has.
    bool armed = false;
    for (int i = 0; i < 100 && !armed; ++i) {
        press("ctrl+Return");
        std::this_thread::sleep_for(milliseconds(100));
        CommandTopic command{};
        while (controller_->gui()->commands.next(commands_place_, command))
            if (command.kind == static_cast<std::uint16_t>(CommandKind::arm)) {
                last_ = command;
                armed = true;
            }
    }
    ASSERT_TRUE(armed) << log_text();
    be(RunState::armed, &last_);
    press("space");
    ASSERT_TRUE(commanded(CommandKind::disarm)) << log_text();
}

TEST_F(KeysInTheWindow, a_digit_selects_the_body_of_that_number) {
    press("0");
    ASSERT_TRUE(commanded(CommandKind::select_body)) << log_text();
    EXPECT_EQ(last_.body, kNoBody);
    press("1");
    ASSERT_TRUE(commanded(CommandKind::select_body)) << log_text();
    EXPECT_NE(last_.body, kNoBody);
}

class ClicksInTheWindow : public KeysInTheWindow {
protected:
    ClicksInTheWindow() { stereo_ = "off"; }
    // All over the middle of the view, where the structure is. between: what xdotool does while the button is down.
    static void click_all_over(const std::string& between) {
        std::string all = "xdotool";
        for (int y = 120; y <= 220; y += 25)
            for (int x = 390; x <= 490; x += 25)
                all += " mousemove " + std::to_string(x) + " " + std::to_string(y) +
                       " sleep 0.05 mousedown 1 sleep 0.05 " + between + " mouseup 1 sleep 0.05";
        ASSERT_EQ(std::system(all.c_str()), 0);
    }
};

TEST_F(ClicksInTheWindow, a_click_on_a_body_holds_it_and_a_drag_does_not) {
    BodiesTopic bodies{};  // the helix, held by nobody
    bodies.taken_at_ns = to_ns(Monotonic::now());
    bodies.count = 1;
    bodies.active = kNoBody;
    std::fill_n(bodies.body[0].pos_model_m, 3, 20e-10);
    bodies.body[0].quat_model_body_xyzw[3] = 1.0;
    bodies.body[0].id = 1;
    controller_->region().bodies.publish(bodies);
    click_all_over("mousemove_relative 20 0 sleep 0.05 mousemove_relative -- -20 0 sleep 0.05");
    click_all_over("sleep 0.5");  // held too long
    press("0");
    ASSERT_TRUE(commanded(CommandKind::select_body)) << log_text();
    EXPECT_EQ(last_.body, kNoBody) << "a drag or a long press selected a body";
    click_all_over("");
    ASSERT_TRUE(commanded(CommandKind::select_body)) << log_text();
    EXPECT_NE(last_.body, kNoBody);
}

}  // namespace
}  // namespace tact::gui_keys_window_test
