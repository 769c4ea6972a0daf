// The reader of a SpaceMouse against a daemon on a real socket, which ends, comes back, floods and sends garbage.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <random>
#include <vector>

#include "gui/input/space_mouse.hpp"
#include "ipc/spacenav/spacenav_socket.hpp"
#include "tests/support/fake_spacenavd.hpp"

// After Eigen, which X11's macros would break.
#include <spnav.h>

namespace tact::gui_space_mouse_test {
namespace {

using test::FakeSpacenavd;

class SpaceMouseTest : public testing::Test {
protected:
    void SetUp() override {
        daemon_.stop();
        alone_ = find_spacenav().service != SpacenavService::answers;
        daemon_.start();
    }
    // The newest state that is as wanted; fails after 5 s.
    SpaceMouseState until(const char* what, const std::function<bool(const SpaceMouseState&)>& wanted) {
        const Instant begun = Monotonic::now();
        SpaceMouseState s;
        do {
            s = mouse().take();
            if (wanted(s)) return s;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        } while (Monotonic::now() - begun < std::chrono::seconds(5));
        ADD_FAILURE() << "not within 5 s: " << what << "; " << space_mouse_text(s);
        return s;
    }
    SpaceMouse& mouse() {
        if (!mouse_) mouse_ = std::make_unique<SpaceMouse>();
        return *mouse_;
    }
    void begin(std::int32_t type = SPNAV_DEV_SMPRO) {
        static_cast<void>(mouse());
        ASSERT_TRUE(daemon_.welcome(type));
    }
    FakeSpacenavd daemon_;
    bool alone_ = true;  // else libspnav falls back to a spacenavd of this machine
    std::unique_ptr<SpaceMouse> mouse_;
};

TEST_F(SpaceMouseTest, motion_buttons_and_the_name_of_the_device_arrive) {
    begin();
    until("the name", [](const auto& s) { return space_mouse_text(s) == "SpaceMouse Pro"; });
    ASSERT_TRUE(daemon_.motion(1, -2, 3, -4, 5, -6) && daemon_.button(1, true));
    const SpaceMouseState s = until("motion", [](const auto& n) { return n.events.buttons == 2U; });
    EXPECT_EQ(s.events.axes, (std::array<std::int32_t, 6>{1, -2, 3, -4, 5, -6}));
    EXPECT_TRUE(daemon_.button(1, false));
    until("release", [](const auto& n) { return n.events.buttons == 0U; });
}

TEST_F(SpaceMouseTest, a_press_shorter_than_a_frame_is_seen_once) {
    begin();
    until("connected", [](const auto& s) { return s.events.device == SpacenavDevice::present; });
    ASSERT_TRUE(daemon_.button(0, true) && daemon_.button(0, false) && daemon_.motion(7, 0, 0));
    const SpaceMouseState s = until("motion", [](const auto& n) { return n.events.axes[0] == 7; });
    const std::uint32_t pressed = s.events.pressed | s.events.buttons;
    EXPECT_EQ(pressed & 1U, 1U);
    EXPECT_EQ(mouse().take().events.pressed, 0U);
}

TEST_F(SpaceMouseTest, unplugging_brings_the_cap_to_rest_and_is_a_new_connection) {
    begin();
    ASSERT_TRUE(daemon_.motion(300, 0, 0) && daemon_.button(0, true));
    const std::uint64_t first = until("motion", [](const auto& s) {
                                    return s.events.axes[0] == 300 && s.events.buttons == 1;
                                }).connection;
    ASSERT_TRUE(daemon_.device(false) && daemon_.answer_type(-1));
    const SpaceMouseState s =
        until("unplugged", [](const auto& n) { return n.events.device == SpacenavDevice::absent; });
    EXPECT_EQ(s.events.axes[0], 0);
    EXPECT_EQ(s.events.buttons, 0U);
    EXPECT_NE(s.connection, first);
    EXPECT_FALSE(space_mouse_sample(s, {}).present);
    ASSERT_TRUE(daemon_.device(true) && daemon_.answer_type(SPNAV_DEV_SNAV));
    until("plugged in", [](const auto& n) { return space_mouse_text(n) == "SpaceNavigator"; });
}

TEST_F(SpaceMouseTest, one_of_two_devices_that_leaves_releases_what_it_held) {
    begin();
    ASSERT_TRUE(daemon_.motion(300, 0, 0) && daemon_.button(0, true));
    until("motion", [](const auto& s) { return s.events.axes[0] == 300 && s.events.buttons == 1; });
    ASSERT_TRUE(daemon_.device(false) && daemon_.answer_type(SPNAV_DEV_SNAV));
    const SpaceMouseState s =
        until("the other device", [](const auto& n) { return n.events.type == SPNAV_DEV_SNAV; });
    EXPECT_EQ(s.events.axes[0], 0);
    EXPECT_EQ(s.events.buttons, 0U);
    EXPECT_TRUE(space_mouse_sample(s, {}).present);
}

TEST_F(SpaceMouseTest, a_daemon_that_ends_is_said_and_found_again) {
    if (!alone_) GTEST_SKIP() << "a spacenavd of this machine runs";
    for (int i = 0; i < 2; ++i) {
        begin();
        ASSERT_TRUE(daemon_.motion(100, 0, 0));
        const std::uint64_t before =
            until("motion", [](const auto& s) { return s.events.axes[0] == 100; }).connection;
        daemon_.stop(i == 0);  // killed, then stopped
        const SpaceMouseState s = until("the end", [](const auto& n) { return !n.connected; });
        EXPECT_EQ(s.events.axes[0], 0);
        EXPECT_NE(s.connection, before);
        until("the fix", [](const auto& n) { return n.problem.find("spacenavd") != std::string::npos; });
        std::filesystem::remove(daemon_.path());
        daemon_.start();
    }
    begin();
    until("again", [](const auto& n) { return n.connected; });
}

TEST_F(SpaceMouseTest, without_a_daemon_the_reader_says_what_to_do_and_waits) {
    if (!alone_) GTEST_SKIP() << "a spacenavd of this machine runs";
    daemon_.stop();
    const SpaceMouseState s = until("the problem", [](const auto& n) { return !n.problem.empty(); });
    EXPECT_EQ(space_mouse_text(s), "not found. Install and start spacenavd.");
    EXPECT_FALSE(s.connected);
    daemon_.start();
    ASSERT_TRUE(daemon_.welcome(0));
    until("found", [](const auto& n) { return n.connected && n.problem.empty(); });
}

TEST_F(SpaceMouseTest, an_old_daemon_that_answers_no_request_works_too) {
    static_cast<void>(mouse());
    ASSERT_TRUE(daemon_.meet());  // and no answer: libspnav falls back to protocol 0
    until("connected", [](const auto& s) { return s.connected; });
    ASSERT_TRUE(daemon_.motion(9, 0, 0));
    until("motion", [](const auto& s) { return s.events.axes[0] == 9; });
}

TEST_F(SpaceMouseTest, a_daemon_that_falls_silent_does_not_move_the_tool_for_ever) {
    begin();
    ASSERT_TRUE(daemon_.motion(300, 0, 0));
    const Instant moved = Monotonic::now();
    until("motion", [](const auto& s) { return s.events.axes[0] == 300; });
    std::this_thread::sleep_until(moved + SpaceMouse::kSilentMost / 2);
    EXPECT_EQ(mouse().take().events.axes[0], 300);  // a cap held still may send nothing
    std::this_thread::sleep_until(moved + SpaceMouse::kSilentMost / 2 + std::chrono::seconds(1));
    until("rest", [](const auto& s) { return s.events.axes[0] == 0; });
    EXPECT_GE(to_s(Monotonic::now() - moved), to_s(SpaceMouse::kSilentMost));
    ASSERT_TRUE(daemon_.motion(200, 0, 0));
    until("motion again", [](const auto& s) { return s.events.axes[0] == 200; });
}

TEST_F(SpaceMouseTest, a_flood_costs_the_frame_nothing) {
    begin();
    until("connected", [](const auto& s) { return s.connected; });
    const std::vector<FakeSpacenavd::Packet> packets(2048, {0, 5, 0, 0, 0, 0, 0, 16});
    std::size_t sent = 0;
    Duration longest{0};
    const Instant begun = Monotonic::now();
    while (Monotonic::now() - begun < std::chrono::milliseconds(300)) {
        sent += daemon_.flood(packets.data(), packets.size() * sizeof packets[0]);
        const Instant before = Monotonic::now();
        static_cast<void>(mouse().take());
        longest = std::max(longest, Duration(Monotonic::now() - before));
    }
    // What the reader took is bounded: the rest waits in the daemon.
    const auto batches = static_cast<double>((Monotonic::now() - begun) / SpaceMouse::kBatchEvery + 2);
    const double taken = static_cast<double>(mouse().take().events.events) * sizeof packets[0];
    EXPECT_LE(taken, batches * static_cast<double>(SpaceMouse::kBatchBytes));
    EXPECT_GT(sent, std::size_t{100'000});
    EXPECT_LT(to_s(longest), 0.1);  // on a busy machine; it waits for no daemon
}

TEST_F(SpaceMouseTest, garbage_never_deflects_more_than_the_bound_and_ends_the_connection) {
    std::mt19937 random(5);
    for (int i = 0; i < 3; ++i) {
        begin();
        until("connected", [](const auto& s) { return s.connected; });
        std::vector<std::uint32_t> bytes(4096);
        for (auto& b : bytes) b = static_cast<std::uint32_t>(random()) | 0x80000000U;
        daemon_.flood(bytes.data(), bytes.size() * sizeof bytes[0]);
        const SpaceMouseState s = until("hung up", [](const auto& n) {
            for (const std::int32_t axis : n.events.axes) EXPECT_LE(std::abs(axis), SpacenavState::kAxisMost);
            return !n.connected;
        });
        EXPECT_EQ(s.events.buttons, 0U);
    }
}

TEST_F(SpaceMouseTest, the_reader_ends_at_once_also_with_half_a_word_of_the_daemon) {
    begin();
    until("connected", [](const auto& s) { return s.connected; });
    ASSERT_TRUE(daemon_.send("half", 4));
    Instant before = Monotonic::now();
    mouse_.reset();
    EXPECT_LT(to_s(Monotonic::now() - before), 0.3);
    // Here libspnav itself waits for the other half of the answer.
    static_cast<void>(mouse());
    ASSERT_TRUE(daemon_.meet());
    ASSERT_TRUE(daemon_.send("ha", 2));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    before = Monotonic::now();
    EXPECT_FALSE(mouse().take().connected);
    mouse_.reset();
    EXPECT_LT(to_s(Monotonic::now() - before), 1.2);
}

TEST(SpacenavSocket, what_is_wrong_is_told_apart) {
    FakeSpacenavd daemon;
    EXPECT_EQ(find_spacenav().service, SpacenavService::answers);
    EXPECT_EQ(find_spacenav().path, daemon.path());
    EXPECT_EQ(spacenav_problem(find_spacenav()), "");
    daemon.stop(true);
    if (find_spacenav().service == SpacenavService::answers) GTEST_SKIP() << "a spacenavd runs here";
    EXPECT_EQ(find_spacenav().service, SpacenavService::refuses);
    EXPECT_NE(spacenav_problem(find_spacenav()).find(daemon.path()), std::string::npos);
    std::filesystem::remove(daemon.path());
    EXPECT_EQ(find_spacenav().service, SpacenavService::absent);
    ::setenv("SPNAV_SOCKET", std::string(500, 'x').c_str(), 1);
    EXPECT_EQ(find_spacenav().service, SpacenavService::absent);
}

TEST(SpacenavSocket, the_paths_are_those_of_libspnav_in_its_order) {
    ScratchFolder root;
    std::filesystem::create_directories(root.path() / "etc");
    ::unsetenv("SPNAV_SOCKET");
    const std::string usual = (root.path() / "var/run/spnav.sock").string();
    EXPECT_EQ(spacenav_paths(root.path()), std::vector{usual});
    std::ofstream(root.path() / "etc/spnavrc")
        << "# socket = /no\n\nsensitivity = 2\n  socket = /tmp/own  \nsocket=/other\n";
    EXPECT_EQ(spacenav_paths(root.path()), (std::vector<std::string>{"/tmp/own", usual}));
    ::setenv("SPNAV_SOCKET", "/first", 1);
    EXPECT_EQ(spacenav_paths(root.path()), (std::vector<std::string>{"/first", "/tmp/own", usual}));
    ::unsetenv("SPNAV_SOCKET");
}

}  // namespace
}  // namespace tact::gui_space_mouse_test
