// Stereo through a screen whose position is known, the head's pose, and the stage file.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "gui/render/screen.hpp"
#include "gui/stereo/eye_pictures.hpp"
#include "gui/stereo/head_view.hpp"
#include "gui/stereo/stage_file.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"

namespace tact::gui_stage_test {
namespace {

constexpr double kWidthPx = 1920.0, kHeightPx = 1080.0;

// Where the straight line from an eye to a point in the room crosses the screen, in pixels from its lower left corner:
// where the point would appear through a pane of glass.
Eigen::Vector2d through_glass(const ScreenPlace& s, const Vec3& eye_m, const Vec3& place_m) {
    const Vec3 along = s.lower_right_m - s.lower_left_m, up = s.upper_left_m - s.lower_left_m;
    Eigen::Matrix3d m;
    m << along, up, eye_m - place_m;
    const Vec3 part = m.colPivHouseholderQr().solve(eye_m - s.lower_left_m);
    return {part.x() * kWidthPx, part.y() * kHeightPx};
}

Eigen::Vector2d drawn_at(const EyeView& eye, const Vec3& scene_a) {
    const Eigen::Vector4f clip = eye.projection * eye.eye_from_scene * scene_a.cast<float>().homogeneous();
    EXPECT_GT(clip.w(), 0.0F);
    EXPECT_LT(std::abs(clip.z()), clip.w());  // between the near and the far plane
    return {0.5 * kWidthPx * (1.0 + static_cast<double>(clip.x() / clip.w())),
            0.5 * kHeightPx * (1.0 + static_cast<double>(clip.y() / clip.w()))};
}

Pose head_pose(SeededRandom& random) {
    const auto within = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
    return {Vec3(within(0.4), within(0.3), 0.55 + within(0.25)),
            quat_from_rotation_vector(Vec3(within(0.5), within(0.6), within(0.3)))};
}

// A screen that leans back, turned and off the origin: a symmetric frustum would be wrong everywhere.
ScreenPlace leaning() {
    const Quat turn = quat_from_rotation_vector(Vec3(-0.4, 0.3, 0.1));
    const Vec3 at(0.2, -0.1, -0.15);
    return {at + turn * Vec3(-0.6, -0.3375, 0.0), at + turn * Vec3(0.6, -0.3375, 0.0),
            at + turn * Vec3(-0.6, 0.3375, 0.0)};
}

TEST(Screen, a_point_in_the_room_is_drawn_on_the_line_of_sight_of_each_eye) {
    SeededRandom random(11);
    for (const ScreenPlace& screen : {ScreenPlace::of_size(0.53, 0.298), leaning()}) {
        ASSERT_TRUE(screen.possible());
        const Pose T_screen_world{Vec3(0.03, -0.02, 0.12), quat_from_rotation_vector(Vec3(0.1, -0.2, 0.3))};
        const double world_per_model = 4e6;  // 1 Å is 0.4 mm
        const Vec3 centre_world_m(0.01, 0.02, -0.03);
        const ScenePlace scene = in_workspace(world_per_model, centre_world_m, T_screen_world);
        double moved_px = 0.0;
        Eigen::Vector2d before(0.0, 0.0);
        for (int head = 0; head < 20; ++head) {
            const auto eyes =
                eyes_of(head_pose(random), {.apart_m = 0.064, .middle_head_m = Vec3(0.0, -0.04, -0.03)});
            EXPECT_NEAR((eyes[1] - eyes[0]).norm(), 0.064, 1e-12);
            for (const Vec3& eye_m : eyes) {
                const EyeView view = through_screen(screen, scene, eye_m, 150.0, Vec3::Zero());
                for (const Vec3& scene_a :
                     {Vec3(0.0, 0.0, 0.0), Vec3(80.0, -60.0, 90.0), Vec3(-100.0, 70.0, -90.0)}) {
                    // The hand's world, through the model, as the controller computes it.
                    const Vec3 world_m = centre_world_m + world_per_model * 1e-10 * scene_a;
                    const Eigen::Vector2d wanted = through_glass(screen, eye_m, T_screen_world * world_m),
                                          drawn = drawn_at(view, scene_a);
                    EXPECT_LT((drawn - wanted).norm(), 0.05) << "head " << head;
                    if (scene_a.x() > 0.0) {
                        moved_px = std::max(moved_px, (drawn - before).norm());
                        before = drawn;
                    }
                }
            }
        }
        EXPECT_GT(moved_px, 50.0);  // the heads were in different places
    }
}

TEST(Screen, a_point_on_the_screen_stays_in_place_for_every_eye) {
    SeededRandom random(4);
    const ScreenPlace screen = leaning();
    Camera camera;
    camera.frame(40.0F);
    camera.rotate(200.0F, -90.0F, 700.0F);
    const ScenePlace scene = orbiting(camera, screen);
    const Vec3 target_a = camera.target_a().cast<double>();
    for (int i = 0; i < 20; ++i)
        for (const Vec3& eye_m : eyes_of(head_pose(random), {}))
            EXPECT_LT((drawn_at(through_screen(screen, scene, eye_m, 40.0, target_a), target_a) -
                       Eigen::Vector2d(0.5 * kWidthPx, 0.5 * kHeightPx))
                          .norm(),
                      0.05);
}

TEST(Screen, orbiting_agrees_with_the_window_for_a_centred_eye) {
    Camera camera;
    camera.frame(40.0F);
    camera.rotate(150.0F, 40.0F, 700.0F);
    camera.pan(30.0F, -20.0F, 700.0F);
    const ScreenPlace screen = ScreenPlace::of_size(0.48, 0.27);
    const double distance_m = 0.5 * 0.27 / std::tan(0.5 * static_cast<double>(Camera::kFieldOfViewRad));
    const Vec3 target_a = camera.target_a().cast<double>();
    const EyeView stereo = through_screen(screen, orbiting(camera, screen), Vec3(0.0, 0.0, distance_m), 40.0,
                                          target_a),
                  window = camera.eye(static_cast<float>(0.48 / 0.27));
    EXPECT_NEAR(static_cast<double>(stereo.target_a), static_cast<double>(window.target_a), 0.01);
    for (const Vec3& p : {Vec3(3.0, 4.0, 5.0), Vec3(-20.0, 10.0, -12.0), Vec3(0.0, -25.0, 20.0)})
        EXPECT_LT((drawn_at(stereo, p) - drawn_at(window, p)).norm(), 0.1);
}

TEST(Screen, eyes_can_be_swapped_and_an_eye_in_the_screen_is_moved_out_of_it) {
    const Pose head{Vec3(0.1, 0.0, 0.6), Quat::Identity()};
    const auto plain = eyes_of(head, {}), swapped = eyes_of(head, {.swapped = true});
    EXPECT_LT(plain[0].x(), plain[1].x());
    EXPECT_EQ(plain[0], swapped[1]);
    EXPECT_EQ(plain[1], swapped[0]);
    const ScreenPlace screen = ScreenPlace::of_size(0.5, 0.3);
    for (const Vec3& eye_m : {Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.0, -3.0), Vec3(NAN, 0.0, INFINITY)}) {
        const EyeView view = through_screen(screen, {}, eye_m, 50.0, Vec3::Zero());
        EXPECT_TRUE(view.projection.allFinite());
        EXPECT_TRUE(view.eye_from_scene.allFinite());
    }
}

HeadTopic head_at(double x_m, double speed_m_s, std::int64_t taken_at_ns, std::uint8_t state = 2) {
    HeadTopic h{};
    h.taken_at_ns = taken_at_ns;
    h.sequence = 1 + static_cast<std::uint64_t>(taken_at_ns / 1'000'000);
    h.pos_screen_m[0] = x_m;
    h.pos_screen_m[2] = 0.6;
    h.velocity_screen_m_s[0] = speed_m_s;
    h.quat_screen_head_xyzw[3] = 1.0;
    h.state = state;
    return h;
}
constexpr std::int64_t kMs = 1'000'000;
const Pose kRest{Vec3(0.0, 0.0, 0.6), Quat::Identity()};

TEST(HeadView, predicts_a_moving_head_to_the_time_of_display) {
    HeadView view(kRest);
    for (std::int64_t t = 1; t < 2000; t += 10) {
        const HeadTopic h = head_at(0.5e-9 * static_cast<double>((t - 4) * kMs), 0.5, (t - 4) * kMs);
        view.follow(&h, t * kMs, (t + 26) * kMs);
    }
    EXPECT_EQ(view.sight(), HeadSight::seen);
    EXPECT_NEAR(view.pose().p_m.x(), 0.5 * 1e-3 * (1991 + 26), 1e-4);
    // No farther than the horizon, however late the frame is.
    const HeadTopic h = head_at(1.0, 0.5, 1996 * kMs);
    view.follow(&h, 2000 * kMs, 9000 * kMs);
    EXPECT_LT(view.pose().p_m.x(), 1.0 + 0.5 * 0.05 + 1e-3);
}

TEST(HeadView, a_lost_head_freezes_the_view_and_its_return_is_smooth) {
    HeadView view(kRest);
    EXPECT_EQ(view.follow(nullptr, kMs, 20 * kMs).p_m, kRest.p_m);
    EXPECT_EQ(view.sight(), HeadSight::none);
    std::int64_t t = 2 * kMs;
    const auto frames = [&](int count, const auto& head) {
        double most_m = 0.0;
        for (int i = 0; i < count; ++i, t += 16 * kMs) {
            const Vec3 before_m = view.pose().p_m;
            const HeadTopic h = head(t);
            view.follow(&h, t, t + 20 * kMs);
            most_m = std::max(most_m, (view.pose().p_m - before_m).norm());
        }
        return most_m;
    };
    frames(200, [](std::int64_t now) { return head_at(0.2, 0.0, now - 3 * kMs); });
    EXPECT_NEAR(view.pose().p_m.x(), 0.2, 1e-6);
    // Frozen at its last pose, although the topic reports a speed.
    const std::int64_t lost_at = t;
    EXPECT_LT(frames(60, [&](std::int64_t) { return head_at(0.2, 1.0, lost_at, 1); }), 1e-6);
    EXPECT_EQ(view.sight(), HeadSight::lost);
    EXPECT_NEAR(view.pose().p_m.x(), 0.2, 1e-6);
    // Back at another place: the view follows by a few centimetres per frame at most and arrives within a second.
    EXPECT_LT(frames(60, [](std::int64_t now) { return head_at(-0.1, 0.0, now - 3 * kMs); }), 0.05);
    EXPECT_EQ(view.sight(), HeadSight::seen);
    EXPECT_NEAR(view.pose().p_m.x(), -0.1, 1e-3);
    // The controller exits.
    view.follow(nullptr, t, t + 20 * kMs);
    EXPECT_EQ(view.sight(), HeadSight::lost);
    EXPECT_NEAR(view.pose().p_m.x(), -0.1, 1e-3);
}

TEST(StageFile, every_key_is_read) {
    const StageSettings s = read_stage_text(R"(
mode = "two-windows"
monitors = [1, 2]
size_px = [800, 600]
place = "workspace"
latency_ms = 12.5
[screen]
lower_left_m = [-1.0, -0.5, 0.1]
lower_right_m = [1.0, -0.5, 0.1]
upper_left_m = [-1.0, 0.6, 0.1]
[eyes]
apart_m = 0.062
swapped = true
middle_head_m = [0.0, -0.05, -0.02]
rest_screen_m = [0.0, 0.1, 1.2]
[workspace]
position_screen_m = [0.0, -0.2, 0.4]
quat_screen_world_xyzw = [0.0, 1.0, 0.0, 0.0]
)",
                                            "s.toml");
    EXPECT_EQ(s.mode, StereoMode::two_windows);
    EXPECT_EQ(s.monitors, (std::vector<int>{1, 2}));
    EXPECT_EQ(s.width_px, 800);
    EXPECT_TRUE(s.in_workspace && s.eyes.swapped && s.screen_measured);
    EXPECT_NEAR(s.latency_s, 0.0125, 1e-12);
    EXPECT_NEAR(s.screen.height_m(), 1.1, 1e-12);
    EXPECT_EQ(s.rest_screen_m, Vec3(0.0, 0.1, 1.2));
    EXPECT_EQ(s.T_screen_world.p_m, Vec3(0.0, -0.2, 0.4));
    EXPECT_EQ(read_stage_text("", "e").mode, StereoMode::off);
    EXPECT_FALSE(read_stage_text("mode = \"anaglyph\"", "a").own_windows());
    EXPECT_TRUE(read_stage_text("mode = \"side-by-side\"\nmonitors = [0]", "a").own_windows());
}

TEST(StageFile, the_faulty_key_is_named_in_the_error) {
    const auto says = [](const char* text, const char* word) {
        try {
            static_cast<void>(read_stage_text(text, "wall.toml"));
            ADD_FAILURE() << text << ": accepted";
        } catch (const StartupError& e) {
            const std::string what = e.what();
            EXPECT_NE(what.find("wall.toml"), std::string::npos);
            EXPECT_NE(what.find(word), std::string::npos) << what;
        }
    };
    says("mode = \"sideways\"", "mode");
    says("mode = 3", "mode");
    says("colour = 1", "colour");
    says("[eyes]\napart_m = 2.0", "eyes.apart_m");
    says("[eyes]\napart_m = nan", "eyes.apart_m");
    says("[eyes]\nswapped = 1", "eyes.swapped");
    says("[screen]\nlower_left_m = [0, 0]", "screen.lower_left_m");
    says("[screen]\nlower_left_m = [0.26, -0.15, 0.0]", "screen");
    says("[workspace]\nquat_screen_world_xyzw = [0, 0, 0, 0.5]", "quat_screen_world_xyzw");
    says("monitors = [1, 2, 3]", "monitors");
    says("monitors = [-1]", "monitors");
    says("place = \"here\"", "place");
    says("mode = \"off", "line 1");
    EXPECT_THROW(static_cast<void>(read_stage_file("no/such/file.toml")), StartupError);
}

TEST(Stereo, each_eye_has_its_area_of_the_output) {
    const PixelArea left = area_of_eye(StereoMode::side_by_side, 0, 1921, 1080),
                    right = area_of_eye(StereoMode::side_by_side, 1, 1921, 1080);
    EXPECT_EQ(left.width_px, right.width_px);
    EXPECT_LE(left.x_px + left.width_px, right.x_px);
    EXPECT_EQ(right.x_px + right.width_px, 1921);
    const PixelArea above = area_of_eye(StereoMode::top_bottom, 0, 1920, 1080);
    EXPECT_EQ(above.y_px, 540);
    EXPECT_EQ(above.height_px, 540);
    EXPECT_EQ(area_of_eye(StereoMode::anaglyph, 1, 640, 480).width_px, 640);
}

// Among so many rotations, some quaternions change their last digit when their rounded numbers are normalized.
TEST(StageFile, any_rotation_is_found_again_in_its_file_and_no_other) {
    SeededRandom random(11);
    char folder[] = "/tmp/tact-stage-XXXXXX";
    const std::filesystem::path path = std::filesystem::path(mkdtemp(folder)) / "lab.toml";
    StageSettings s;
    int changed = 0;
    for (int k = 0; k < 300; ++k) {
        s.T_screen_world.q = random.rotation();
        const std::string text = stage_text(s);
        std::ofstream(path) << text << std::flush;
        EXPECT_TRUE(is_in_stage_file(s, path)) << text;
        if (stage_text(read_stage_file(path)) != text) ++changed;
    }
    EXPECT_GT(changed, 0) << "otherwise this tests nothing";
    s.eyes.apart_m += 1e-6;
    EXPECT_FALSE(is_in_stage_file(s, path));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace tact::gui_stage_test
