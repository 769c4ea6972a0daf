// The mouse as a hand: from the pointer's motion to a pose, and what is drawn of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gui/render/camera.hpp"
#include "gui/render/mouse_handle.hpp"
#include "gui/window/steer_camera.hpp"
#include "gui/window/tool_drag.hpp"

namespace tact::gui_mouse_test {
namespace {

class ToolDragTest : public testing::Test {
protected:
    ToolDragTest() {
        meta_.world_per_model = 8e6;
        meta_.centre_model_m[0] = 2e-9;
        camera_.frame(60.0F);
        camera_.rotate(130.0F, -70.0F, 500.0F);
    }
    [[nodiscard]] DragView view() const {
        return {camera_.eye(960.0F / 520.0F),
                camera_.orientation(),
                {320.0F, 0.0F, 960.0F, 520.0F},
                centre_m_,
                &meta_};
    }
    // A tool that is drawn a little beside the hand, as a body that the hand grips.
    [[nodiscard]] DragTool tool(const Vec3& world_m = {0.002, 0.004, -0.001}) const {
        return {true,
                {world_m, Quat(Eigen::AngleAxisd(0.4, Vec3::UnitY()))},
                meta_.to_model(world_m) + Vec3(3e-10, 0, 2e-10)};
    }
    [[nodiscard]] Eigen::Vector2f target_px() const {
        return *ToolDrag::on_screen(view(), drag_.target_model_m(meta_));
    }

    SceneMeta meta_{};
    Vec3 centre_m_{2.1e-9, 1e-10, 0.0};
    Camera camera_;
    ToolDrag drag_;
};

TEST_F(ToolDragTest, taking_a_tool_begins_at_its_pose_and_where_it_is_drawn) {
    drag_.take(1, tool(), meta_, HeldBy::button);
    drag_.move(view(), {});
    EXPECT_EQ(drag_.target().p_m, tool().T_world_tool.p_m);
    EXPECT_LT((drag_.target_model_m(meta_) - tool().at_model_m).norm(), 1e-16);
    EXPECT_EQ(drag_.hand(), 1U);
    const MouseTopic t = drag_.record(9, 77);
    EXPECT_TRUE(sensible(t));
    EXPECT_EQ(t.holds, 1);
    EXPECT_EQ(t.hand, 1);
    EXPECT_EQ(t.generation, 9U);
    EXPECT_EQ(t.taken_at_ns, 77);
}

TEST_F(ToolDragTest, the_target_stays_under_the_pointer_at_its_depth_from_any_side) {
    for (const float turned : {0.0F, 90.0F, 400.0F}) {
        camera_.rotate(turned, 0.5F * turned, 500.0F);
        drag_.take(0, tool(), meta_, HeldBy::button);
        const Eigen::Vector2f begun = target_px();
        const float depth = (view().eye.eye_from_scene *
                             ((drag_.target_model_m(meta_) - centre_m_) * 1e10).cast<float>().homogeneous())
                                .z();
        for (int i = 0; i < 10; ++i) drag_.move(view(), {.dx = 7.0F, .dy = -4.0F});
        EXPECT_LT((target_px() - begun - Eigen::Vector2f(70.0F, -40.0F)).norm(), 0.05F);
        EXPECT_NEAR((view().eye.eye_from_scene *
                     ((drag_.target_model_m(meta_) - centre_m_) * 1e10).cast<float>().homogeneous())
                        .z(),
                    depth, 0.01F);
        EXPECT_LT(drag_.target().q.angularDistance(tool().T_world_tool.q), 1e-9);
    }
}

TEST_F(ToolDragTest, the_wheel_moves_it_along_the_view_and_fine_is_a_fifth) {
    drag_.take(0, tool(), meta_, HeldBy::button);
    drag_.move(view(), {.wheel = 2.0F});
    const Vec3 away = drag_.target().p_m - tool().T_world_tool.p_m;
    const Vec3 seen = camera_.orientation().cast<double>() * away;
    EXPECT_LT((seen - Vec3(0.0, 0.0, -2.0 * ToolDrag::kWheelM)).norm(), 1e-8);
    drag_.take(0, tool(), meta_, HeldBy::button);
    drag_.move(view(), {.wheel = 2.0F, .fine = true});
    EXPECT_LT((drag_.target().p_m - tool().T_world_tool.p_m - ToolDrag::kFine * away).norm(), 1e-8);
}

TEST_F(ToolDragTest, turning_turns_the_tool_as_the_camera_turns_the_scene) {
    drag_.take(0, tool(), meta_, HeldBy::button);
    const Quat before = camera_.orientation().cast<double>() * drag_.target().q;
    drag_.move(view(), {.dx = 52.0F, .dy = 13.0F, .turn = true});
    Camera turned = camera_;
    turned.rotate(52.0F, 13.0F, 520.0F);
    const Quat as_camera = turned.orientation().cast<double>() * tool().T_world_tool.q;
    EXPECT_LT((camera_.orientation().cast<double>() * drag_.target().q).angularDistance(as_camera), 1e-5);
    EXPECT_GT(before.angularDistance(as_camera), 0.2);
    EXPECT_EQ(drag_.target().p_m, tool().T_world_tool.p_m);
    // The wheel rolls it about the view.
    drag_.take(0, tool(), meta_, HeldBy::button);
    drag_.move(view(), {.wheel = 1.0F, .turn = true});
    const Vec3 roll = rotation_vector_rad(drag_.target().q * tool().T_world_tool.q.conjugate());
    EXPECT_LT(
        (camera_.orientation().cast<double>() * roll - Vec3(0, 0, static_cast<double>(ToolDrag::kRollRad)))
            .norm(),
        1e-6);
}

TEST_F(ToolDragTest, buttons_are_those_of_the_stylus_and_end_with_the_hold) {
    drag_.take(0, tool(), meta_, HeldBy::key);
    EXPECT_TRUE(drag_.by_key());
    drag_.move(view(), {.drive = true});
    EXPECT_EQ(drag_.record(1, 0).buttons, 2U);
    drag_.move(view(), {.drive = true, .clutch = true});
    EXPECT_EQ(drag_.record(1, 0).buttons, 3U);
    drag_.let_go();
    EXPECT_EQ(drag_.record(1, 0).buttons, 0U);
    EXPECT_EQ(drag_.record(1, 0).holds, 0);
    EXPECT_TRUE(sensible(drag_.record(1, 0)));
    const Pose left = drag_.target();
    drag_.move(view(), {.dx = 50.0F});
    EXPECT_EQ(drag_.target().p_m, left.p_m);
}

TEST_F(ToolDragTest, a_device_steers_in_the_axes_of_the_eye_and_is_named_in_the_record) {
    drag_.take(0, tool(), meta_, HeldBy::spacemouse);
    EXPECT_FALSE(drag_.by_pointer());
    const Vec3 move(1e-3, -2e-3, 3e-3), turn(0.1, 0.2, -0.3);
    drag_.steer(view(), move, turn, 6);
    const Quat eye = camera_.orientation().cast<double>();
    EXPECT_LT((eye * (drag_.target().p_m - tool().T_world_tool.p_m) - move).norm(), 1e-8);
    const Vec3 turned = rotation_vector_rad(drag_.target().q * tool().T_world_tool.q.conjugate());
    EXPECT_LT((eye * turned - turn).norm(), 1e-6);
    MouseTopic t = drag_.record(1, 0);
    EXPECT_TRUE(sensible(t));
    EXPECT_EQ(t.device, static_cast<std::uint8_t>(LeadDevice::spacemouse));
    EXPECT_EQ(t.buttons, 2U);  // the stylus has two
    // At rest, or unplugged: the target stays, and the buttons open.
    const Pose at = drag_.target();
    drag_.steer(view(), Vec3::Zero(), Vec3::Zero(), 0);
    EXPECT_EQ(drag_.target().p_m, at.p_m);
    EXPECT_EQ(drag_.record(1, 0).buttons, 0U);
    EXPECT_EQ(drag_.record(1, 0).holds, 1);
    drag_.take(0, tool(), meta_, HeldBy::gamepad);
    EXPECT_EQ(drag_.record(1, 0).device, static_cast<std::uint8_t>(LeadDevice::gamepad));
    drag_.take(0, tool(), meta_, HeldBy::key);
    EXPECT_EQ(drag_.record(1, 0).device, static_cast<std::uint8_t>(LeadDevice::mouse));
}

TEST_F(ToolDragTest, steering_stays_within_reach_and_takes_no_wild_number) {
    drag_.take(0, tool(), meta_, HeldBy::gamepad);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double wild : {nan, HUGE_VAL, 1e300, -1e300, 1.0}) {
        drag_.steer(view(), Vec3::Constant(wild), Vec3::Zero(), 0xffffffffU);
        EXPECT_TRUE(sensible(drag_.record(1, 0))) << wild;
        drag_.steer(view(), Vec3::Zero(), Vec3(wild, 0.0, 0.0), 0);
        EXPECT_TRUE(sensible(drag_.record(1, 0))) << wild;
        for (int i = 0; i < 3; ++i) EXPECT_LE(std::abs(drag_.target().p_m[i]), ToolDrag::kReachM);
    }
}

TEST_F(ToolDragTest, no_input_leads_to_a_record_that_the_controller_refuses) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    drag_.take(0, tool(), meta_, HeldBy::button);
    for (const float wild : {1e30F, -1e30F, 1e6F, nan, HUGE_VALF}) {
        drag_.move(view(), {.dx = wild, .dy = 1.0F, .wheel = wild});
        EXPECT_TRUE(sensible(drag_.record(1, 0))) << wild;
        drag_.move(view(), {.dx = wild, .dy = wild, .turn = true});
        EXPECT_TRUE(sensible(drag_.record(1, 0))) << wild;
    }
    for (int i = 0; i < 3; ++i) EXPECT_LE(std::abs(drag_.target().p_m[i]), ToolDrag::kReachM);
}

TEST_F(ToolDragTest, the_tool_under_the_pointer_is_the_nearest_that_may_be_led) {
    std::array<DragTool, 2> tools{tool(), tool({0.002, 0.006, -0.001})};
    const Eigen::Vector2f first = *ToolDrag::on_screen(view(), tools[0].at_model_m);
    EXPECT_EQ(ToolDrag::tool_near(view(), tools, first.x(), first.y(), 24.0F), 0U);
    EXPECT_EQ(ToolDrag::tool_near(view(), tools, first.x() + 300.0F, first.y(), 24.0F), std::nullopt);
    tools[0].may = false;
    const auto other = ToolDrag::tool_near(view(), tools, first.x(), first.y(), 200.0F);
    EXPECT_EQ(other, 1U);
    tools[1].may = false;
    EXPECT_EQ(ToolDrag::tool_near(view(), tools, first.x(), first.y(), 1e6F), std::nullopt);
    // Behind the eye it is nowhere.
    const Vec3 behind = centre_m_ + 1e-10 * (3.0F * camera_.eye_a()).cast<double>();
    EXPECT_EQ(ToolDrag::on_screen(view(), behind), std::nullopt);
}

// After half a second, in so many frames.
Camera steered(const Deflection& deflection, int frames) {
    Camera camera;
    camera.frame(60.0F);
    for (int i = 0; i < frames; ++i) steer(camera, view_motion(deflection, 1.0, 0.5 / frames));
    return camera;
}

TEST(SteeredCamera, moves_the_same_at_any_frame_rate) {
    for (const Deflection& d :
         {Deflection{Vec3::Zero(), Vec3(0.3, -0.8, 0.5)}, Deflection{Vec3(0.4, -0.7, 0.0), Vec3::Zero()},
          Deflection{Vec3(0.0, 0.0, -1.0), Vec3::Zero()}}) {
        const Camera slow = steered(d, 6), quick = steered(d, 200);
        EXPECT_LT(slow.orientation().angularDistance(quick.orientation()), 2e-3F);
        EXPECT_LT((slow.target_a() - quick.target_a()).norm(), 1e-2F);
        EXPECT_NEAR(slow.distance_a() / quick.distance_a(), 1.0F, 1e-4F);
    }
}

TEST(SteeredCamera, the_scene_follows_the_cap) {
    Camera home;
    home.frame(60.0F);
    const auto seen = [](const Camera& camera) {  // of the scene's centre, in the eye
        return Eigen::Vector3f((camera.view() * Eigen::Vector4f(0.0F, 0.0F, 0.0F, 1.0F)).head<3>());
    };
    EXPECT_GT(seen(steered({Vec3::UnitX(), Vec3::Zero()}, 30)).x(), 10.0F);
    EXPECT_GT(seen(steered({Vec3::UnitY(), Vec3::Zero()}, 30)).y(), 10.0F);
    EXPECT_LT(steered({Vec3::UnitZ(), Vec3::Zero()}, 30).distance_a(), 0.8F * home.distance_a());
    const Camera turned = steered({Vec3::Zero(), Vec3::UnitY()}, 30);
    const Quat by = (turned.orientation() * home.orientation().conjugate()).cast<double>();
    EXPECT_LT((rotation_vector_rad(by) - Vec3(0.0, 0.5 * RateMotion::kViewTurn_rad_s, 0.0)).norm(), 1e-3);
}

TEST(MouseHandle, a_ring_about_the_tool_and_a_line_to_the_target_while_it_is_held) {
    const Eigen::Vector3f at(1.0F, 2.0F, 3.0F), target(41.0F, 2.0F, 3.0F), to_eye(0.0F, 0.0F, 1.0F);
    DrawnHandle handle;
    const auto reach = [&](const TubeMesh& mesh) {
        float most = 0.0F;
        for (const TubeVertex& v : mesh.vertex)
            most = std::max(most,
                            (Eigen::Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]) - at).norm());
        return most;
    };
    const float ring = reach(build_mouse_handle(handle, at, target, to_eye, 0.5F));
    EXPECT_NEAR(ring, 0.5F * handle.radius_px, 1.0F);
    handle.state = HandleState::near;
    EXPECT_GT(reach(build_mouse_handle(handle, at, target, to_eye, 0.5F)), ring);
    handle.state = HandleState::held;
    EXPECT_GT(reach(build_mouse_handle(handle, at, target, to_eye, 0.5F)), 40.0F);
    const Eigen::Vector3f nowhere = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(build_mouse_handle(handle, nowhere, target, to_eye, 0.5F).index.empty());
    EXPECT_TRUE(build_mouse_handle(handle, at, target, to_eye, 0.0F).index.empty());
}

}  // namespace
}  // namespace tact::gui_mouse_test
