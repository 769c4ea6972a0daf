// SpaceMouse and gamepad: what a deflection means, however the time is cut into frames.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gui/input/gamepad.hpp"
#include "gui/input/space_mouse.hpp"

// After Eigen, which X11's macros would break.
#include <spnav.h>

namespace tact::gui_input_test {
namespace {

const InputChoice kChoice{.role = static_cast<int>(InputRole::hand)};

TEST(RateControl, nothing_moves_within_the_dead_zone_and_full_deflection_is_full_speed) {
    const double zone = kChoice.dead_zone;
    EXPECT_EQ(shaped(zone, kChoice), 0.0);
    EXPECT_EQ(shaped(-zone, kChoice), 0.0);
    EXPECT_GT(shaped(zone + 1e-6, kChoice), 0.0);
    EXPECT_LT(shaped(zone + 1e-6, kChoice), 1e-6);  // continuous
    EXPECT_EQ(shaped(1.0, kChoice), 1.0);
    EXPECT_EQ(shaped(-1.0, kChoice), -1.0);
    EXPECT_NEAR(shaped(0.5 * (1.0 + zone), kChoice), 0.25, 1e-12);
    InputChoice straight = kChoice;
    straight.curve = 1.0;
    EXPECT_NEAR(shaped(0.5 * (1.0 + zone), straight), 0.5, 1e-12);
    double before = -1.0;
    for (int i = -100; i <= 100; ++i) {
        const double now = shaped(0.01 * i, kChoice);
        EXPECT_GE(now, before);
        before = now;
    }
}

TEST(RateControl, no_number_is_too_wild) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const double wild : {nan, inf, -inf, 1e300, -1e300}) {
        EXPECT_LE(std::abs(shaped(wild, kChoice)), 1.0) << wild;
        InputChoice choice = kChoice;
        choice.dead_zone = choice.curve = wild;
        EXPECT_LE(std::abs(shaped(0.9, choice)), 1.0) << wild;
        EXPECT_GT(shaped(0.9, choice), 0.0) << wild;
        const Deflection full{Vec3::Ones(), Vec3::Ones()};
        for (const RateMotion& m : {hand_motion(full, wild, 0.01), hand_motion(full, 1.0, wild),
                                    view_motion(full, wild, 0.01), view_motion(full, 1.0, wild)}) {
            EXPECT_TRUE(m.move.allFinite() && m.turn_rad.allFinite()) << wild;
            EXPECT_LE(m.move.norm(), 10.0);
        }
    }
    EXPECT_EQ(shaped(nan, kChoice), 0.0);
}

TEST(RateControl, a_constant_deflection_integrates_exactly_whatever_the_frame_rate) {
    const Deflection d{Vec3(0.5, -1.0, 0.25), Vec3(1.0, 0.0, -0.5)};
    const auto after_a_second = [&](int frames) {
        Vec3 at = Vec3::Zero();
        Quat q = Quat::Identity();
        for (int i = 0; i < frames; ++i) {
            const RateMotion m = hand_motion(d, 2.0, 1.0 / frames);
            at += m.move;
            q = quat_from_rotation_vector(m.turn_rad) * q;
        }
        return Pose{at, q};
    };
    const Pose coarse = after_a_second(11), fine = after_a_second(997);
    EXPECT_LT((coarse.p_m - 2.0 * RateMotion::kHand_m_s * d.move).norm(), 1e-12);
    EXPECT_LT((fine.p_m - coarse.p_m).norm(), 1e-12);
    EXPECT_LT(fine.q.angularDistance(coarse.q), 1e-9);
    EXPECT_LT(fine.q.angularDistance(quat_from_rotation_vector(2.0 * RateMotion::kHandTurn_rad_s * d.turn)),
              1e-9);
}

TEST(RateControl, a_pause_does_not_jump) {
    const Deflection d{Vec3::UnitX(), Vec3::Zero()};
    EXPECT_EQ(hand_motion(d, 1.0, 20.0).move, hand_motion(d, 1.0, RateMotion::kFrameMost_s).move);
    EXPECT_EQ(hand_motion(d, 1.0, -1.0).move, Vec3::Zero());
}

InputSample sample_of(double x, std::uint64_t connection = 1, std::uint32_t buttons = 0) {
    InputSample s;
    s.present = true;
    s.connection = connection;
    s.deflection.move.x() = x;
    s.buttons = buttons;
    return s;
}

TEST(RestGate, motion_counts_only_once_the_device_was_at_rest) {
    RestGate gate;
    EXPECT_TRUE(gate.pass(sample_of(1.0)).deflection.rests());
    EXPECT_EQ(gate.pass(sample_of(0.0, 1, 1)).buttons, 0U);
    EXPECT_TRUE(gate.pass(sample_of(0.0)).deflection.rests());
    EXPECT_EQ(gate.pass(sample_of(1.0, 1, 2)).deflection.move.x(), 1.0);
    EXPECT_EQ(gate.pass(sample_of(1.0, 1, 2)).buttons, 2U);
    gate.close();
    EXPECT_TRUE(gate.pass(sample_of(1.0, 1, 2)).deflection.rests());
    EXPECT_EQ(gate.pass(sample_of(1.0, 1, 2)).buttons, 0U);
}

TEST(RestGate, unplugging_stops_the_motion_and_releases_the_buttons) {
    RestGate gate;
    static_cast<void>(gate.pass(sample_of(0.0)));
    EXPECT_FALSE(gate.pass(sample_of(0.5, 1, 3)).deflection.rests());
    InputSample gone = sample_of(0.5, 1, 3);
    gone.present = false;
    EXPECT_TRUE(gate.pass(gone).deflection.rests());
    EXPECT_EQ(gate.pass(gone).buttons, 0U);
    // Plugged in again with the stick still over: nothing, until it was released.
    EXPECT_TRUE(gate.pass(sample_of(0.5, 2, 3)).deflection.rests());
    static_cast<void>(gate.pass(sample_of(0.0, 2)));
    EXPECT_FALSE(gate.pass(sample_of(0.5, 2)).deflection.rests());
    // As fast as between two frames.
    EXPECT_TRUE(gate.pass(sample_of(0.5, 3)).deflection.rests());
}

TEST(SpaceMouseMapping, the_axes_are_those_of_libspnav) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
        SpacenavState events;
        events.axes[axis] = 200;
        spnav_event_motion motion{};
        int* const values[] = {&motion.x, &motion.y, &motion.z, &motion.rx, &motion.ry, &motion.rz};
        *values[axis] = 200;
        spnav_posrot moved;
        spnav_posrot_init(&moved);
        spnav_posrot_moveobj(&moved, &motion);
        const Deflection d = space_mouse_deflection(events);
        const auto of = [](float v) { return static_cast<double>(v); };
        const Vec3 move(of(moved.pos[0]), of(moved.pos[1]), of(moved.pos[2]));
        const Quat turned(of(moved.rot[3]), of(moved.rot[0]), of(moved.rot[1]), of(moved.rot[2]));
        // Of the library: 0.001 for each unit.
        EXPECT_LT((d.move * SpaceMouse::kFull * 1e-3 - move).norm(), 1e-6) << axis;
        EXPECT_LT((d.turn * SpaceMouse::kFull * 1e-3 - rotation_vector_rad(turned)).norm(), 1e-6) << axis;
    }
}

TEST(SpaceMouseMapping, a_daemon_without_a_device_moves_nothing_and_says_so) {
    SpaceMouseState state;
    EXPECT_FALSE(space_mouse_sample(state, kChoice).present);
    state.problem = "not found. Install and start spacenavd.";
    EXPECT_EQ(space_mouse_text(state), state.problem);
    state.connected = true;
    state.events.device = SpacenavDevice::present;
    state.events.type = SPNAV_DEV_SMPRO;
    state.events.axes = {350, 0, 0, 0, 0, 0};
    state.events.buttons = 0xffU;
    EXPECT_EQ(space_mouse_text(state), "SpaceMouse Pro");
    EXPECT_EQ(space_mouse_sample(state, kChoice).deflection.move.x(), 1.0);
    EXPECT_EQ(space_mouse_sample(state, kChoice).buttons, 3U);
    state.events.device = SpacenavDevice::absent;
    EXPECT_FALSE(space_mouse_sample(state, kChoice).present);
    EXPECT_TRUE(space_mouse_sample(state, kChoice).deflection.rests());
    EXPECT_EQ(space_mouse_sample(state, kChoice).buttons, 0U);
    EXPECT_NE(space_mouse_text(state).find("no SpaceMouse is plugged in"), std::string::npos);
}

// A machine's gamepads, as a test wants them.
class FakeGamepads final : public GamepadPort {
public:
    void read(GamepadState& state) override { state = now; }
    GamepadState now;
};

class GamepadTest : public testing::Test {
protected:
    InputSample read(InputRole role = InputRole::hand) {
        gamepad_.read();
        InputChoice choice = kInputDefaults[1];
        choice.role = static_cast<int>(role);
        return gamepad_.sample(choice);
    }
    void plug(const char* name = "Pad") {
        port_.now = {};
        port_.now.connected = true;
        port_.now.name = name;
    }
    FakeGamepads port_;
    Gamepad gamepad_{port_};
};

TEST_F(GamepadTest, the_left_stick_moves_in_the_plane_and_the_triggers_in_depth) {
    plug();
    EXPECT_TRUE(read().deflection.rests());  // released triggers are at -1
    port_.now.axes = {1.0F, -1.0F, 0.0F, 0.0F, -1.0F, 1.0F};
    EXPECT_EQ(read().deflection.move, Vec3(1.0, 1.0, -1.0));
    EXPECT_EQ(read().deflection.turn, Vec3::Zero());
    port_.now.axes = {0.0F, 0.0F, 1.0F, 0.0F, 1.0F, -1.0F};
    EXPECT_EQ(read().deflection.move, Vec3(kGamepadFine, 0.0, 1.0));
}

TEST_F(GamepadTest, a_shoulder_button_turns_instead) {
    plug();
    port_.now.axes = {1.0F, -1.0F, 0.0F, 0.0F, -1.0F, 1.0F};
    for (const std::uint32_t shoulder : {1U << 4U, 1U << 5U}) {
        port_.now.buttons = shoulder;
        EXPECT_EQ(read().deflection.move, Vec3::Zero());
        EXPECT_EQ(read().deflection.turn, Vec3(-1.0, 1.0, -1.0));
        EXPECT_EQ(read().buttons, 0U);
    }
    port_.now.buttons = 1U;
    EXPECT_EQ(read().buttons, 1U);
    port_.now.buttons = 2U;
    EXPECT_EQ(read().buttons, 2U);
}

TEST_F(GamepadTest, as_a_camera_the_left_stick_turns_the_right_one_pans_and_the_triggers_zoom) {
    plug();
    port_.now.axes = {1.0F, 0.0F, 0.0F, -1.0F, -1.0F, 1.0F};
    const Deflection d = read(InputRole::camera).deflection;
    EXPECT_EQ(d.turn, Vec3(0.0, 1.0, 0.0));
    EXPECT_EQ(d.move, Vec3(0.0, 1.0, 1.0));
}

TEST_F(GamepadTest, plugging_in_and_out_is_noticed_and_named) {
    EXPECT_FALSE(read().present);
    EXPECT_EQ(gamepad_.text(), "not found. Plug one in.");
    plug("Blue pad");
    const std::uint64_t first = read().connection;
    EXPECT_TRUE(read().present);
    EXPECT_EQ(gamepad_.text(), "Blue pad");
    port_.now.axes[0] = 1.0F;
    port_.now = {};
    EXPECT_FALSE(read().present);
    EXPECT_TRUE(read().deflection.rests());
    plug("Blue pad");
    EXPECT_NE(read().connection, first);
    plug("Red pad");  // exchanged between two frames
    const std::uint64_t second = read().connection;
    EXPECT_EQ(gamepad_.text(), "Red pad");
    plug("Blue pad");
    EXPECT_NE(read().connection, second);
    port_.now = {};
    port_.now.unknown = true;
    port_.now.name = "Pedals";
    EXPECT_FALSE(read().present);
    EXPECT_NE(gamepad_.text().find("\"Pedals\" has no gamepad mapping"), std::string::npos);
}

TEST_F(GamepadTest, no_axis_is_too_wild) {
    plug();
    for (const float wild : {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF, -1e30F, 5.0F}) {
        port_.now.axes.fill(wild);
        for (const InputRole role : {InputRole::hand, InputRole::camera}) {
            const Deflection d = read(role).deflection;
            EXPECT_LE(d.move.cwiseAbs().maxCoeff(), 1.0 + kGamepadFine);
            EXPECT_LE(d.turn.cwiseAbs().maxCoeff(), 2.0);
        }
    }
}

}  // namespace
}  // namespace tact::gui_input_test
