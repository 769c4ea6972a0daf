// Rendered pixels: impostors against a slow reference, depth cue, the eyes of every stereo mode.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <set>

#include "gui/docking/docking_layer.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/render/screen.hpp"
#include "gui/stereo/eye_pictures.hpp"
#include "gui/window/load_scene.hpp"
#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "tests/unit/gui_draw_canvas.hpp"
#include "tests/unit/gui_fake.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_draw_test {
namespace {

using Distance = std::function<double(const Eigen::Vector3d& eye_a)>;

// One X server and one context for all cases.
class GuiDraw : public DrawCanvas {
protected:
    static std::vector<float> depths() {
        std::vector<float> depth(std::size_t{kWidth} * kHeight);
        glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        return depth;
    }
    Eigen::Matrix4f projection() const {
        return camera_.projection(static_cast<float>(kWidth) / static_cast<float>(kHeight));
    }
    // Marches along the ray of each pixel until the distance to the shape is zero. Slow, and without any formula of the
    // shaders.
    void expect_shape(const Distance& distance) const {
        const Eigen::Matrix4d p = projection().cast<double>();
        const std::vector<float> depth = depths();
        int hits = 0, wrong = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const Eigen::Vector3d ray = Eigen::Vector3d((2.0 * (x + 0.5) / kWidth - 1.0) / p(0, 0),
                                                            (2.0 * (y + 0.5) / kHeight - 1.0) / p(1, 1), -1.0)
                                                .normalized();
                double t = 0.0, nearest = 1e9;
                for (int step = 0; step < 400 && t < 1000.0 && nearest > 1e-4; ++step) {
                    nearest = std::min(nearest, distance(t * ray));
                    t += distance(t * ray);
                }
                const auto seen = static_cast<double>(depth[static_cast<std::size_t>(y * kWidth + x)]);
                const bool hit = nearest <= 1e-4;
                hits += hit ? 1 : 0;
                if (hit != (seen < 1.0)) {
                    // Single precision may differ at pixels that the outline barely touches.
                    if (nearest > 1e-2) ++wrong;
                    continue;
                }
                if (!hit) continue;
                const double z_a = p(2, 3) / (2.0 * seen - 1.0 + p(2, 2));  // distance along the view
                // At grazing rays the depth is very steep, so the distance to the shape is compared.
                EXPECT_NEAR(distance(ray * (z_a / -ray.z())), 0.0, 0.02) << "pixel " << x << ", " << y;
            }
        EXPECT_GT(hits, 20);
        EXPECT_LE(wrong, hits / 50) << "of " << hits;
    }
    ImpostorView impostor_view(const Eigen::Matrix4f& eye) const { return {eye, projection(), haze_}; }

    Haze haze_;
};

Eigen::Vector3d in_eye(const Eigen::Matrix4f& eye, std::array<float, 3> a) {
    return (eye.cast<double>() * Eigen::Vector4d(a[0], a[1], a[2], 1.0)).head<3>();
}

TEST_F(GuiDraw, a_sphere_has_the_right_outline_and_depth) {
    ImpostorPrograms programs;
    const Eigen::Matrix4f eye = camera_.view();
    for (const Sphere& sphere :
         {Sphere{{0.0F, 0.0F, 0.0F}, 6.0F, {}}, Sphere{{14.0F, -9.0F, 10.0F}, 3.0F, {}},
          Sphere{{0.0F, 15.0F, 30.0F}, 8.0F, {}}}) {
        glClear(GL_DEPTH_BUFFER_BIT);
        ImpostorShapes shapes;
        shapes.fill(std::array{sphere});
        programs.use_spheres(impostor_view(eye));
        shapes.draw();
        const Eigen::Vector3d c = in_eye(eye, sphere.centre_a);
        expect_shape(
            [&](const Eigen::Vector3d& p) { return (p - c).norm() - static_cast<double>(sphere.radius_a); });
    }
}

TEST_F(GuiDraw, a_stick_has_the_right_outline_and_depth) {
    ImpostorPrograms programs;
    const Eigen::Matrix4f eye = camera_.view();
    const Eigen::Vector3f towards = camera_.orientation().conjugate() * Eigen::Vector3f(0.0F, 0.0F, 12.0F);
    for (const Stick& stick :
         {Stick{{-8.0F, 3.0F, 0.0F}, 2.0F, {9.0F, -2.0F, 5.0F}, {}, {}},
          Stick{{0.0F, 0.0F, 0.0F}, 3.0F, {towards.x(), towards.y(), towards.z()}, {}, {}},
          Stick{{10.0F, 10.0F, 0.0F}, 1.0F, {10.0F, 10.5F, 0.0F}, {}, {}},
          Stick{{4.0F, 4.0F, 4.0F}, 3.0F, {4.0F, 4.0F, 4.0F}, {}, {}}}) {
        glClear(GL_DEPTH_BUFFER_BIT);
        ImpostorShapes shapes;
        shapes.fill(std::array{stick});
        programs.use_sticks(impostor_view(eye));
        shapes.draw();
        const Eigen::Vector3d a = in_eye(eye, stick.from_a), b = in_eye(eye, stick.to_a);
        expect_shape([&](const Eigen::Vector3d& p) {
            const double length2 = (b - a).squaredNorm();
            const double t = length2 > 0.0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
            return (p - a - t * (b - a)).norm() - static_cast<double>(stick.radius_a);
        });
    }
}

TEST_F(GuiDraw, shapes_that_reach_the_eye_are_skipped) {
    ImpostorPrograms programs;
    const Eigen::Matrix4f eye = Eigen::Matrix4f::Identity();
    ImpostorShapes spheres, sticks;
    spheres.fill(std::array{Sphere{{0.0F, 0.0F, -1.0F}, 2.0F, {}}, Sphere{{0.0F, 0.0F, 50.0F}, 2.0F, {}}});
    sticks.fill(std::array{Stick{{0.0F, 0.0F, 1.0F}, 1.0F, {0.0F, 0.0F, -90.0F}, {}, {}}});
    programs.use_spheres(impostor_view(eye));
    spheres.draw();
    programs.use_sticks(impostor_view(eye));
    sticks.draw();
    for (const float d : depths()) ASSERT_EQ(d, 1.0F);
}

TEST_F(GuiDraw, haze_fades_from_none_to_the_background) {
    ImpostorPrograms programs;
    haze_.strength = 1.0F;
    haze_.top = Eigen::Vector3f(0.2F, 0.4F, 0.6F);
    haze_.bottom = haze_.top;
    const AtomColours red{{255, 0, 0, 255}, {255, 0, 0, 255}};
    ImpostorShapes shapes;
    shapes.fill(std::array{Sphere{{0.0F, 0.0F, 0.0F}, 8.0F, red}});
    const auto middle = [&](float begin_a, float end_a) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        haze_.begin_a = begin_a;
        haze_.end_a = end_a;
        programs.use_spheres(impostor_view(camera_.view()));
        shapes.draw();
        const Image image = read_pixels(kWidth, kHeight);
        const std::size_t at = std::size_t{3} * (kHeight / 2 * kWidth + kWidth / 2);
        return Rgb8{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
    };
    const float d = camera_.distance_a();
    const Rgb8 clear = middle(d + 10.0F, d + 20.0F), gone = middle(d - 30.0F, d - 20.0F);
    EXPECT_GT(clear[0], clear[1] + 50);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(gone[i], 255.0F * haze_.top[i], 1.5F);
}

// Centre of one channel's pixels within an area, from its lower left corner; (-1, -1) if there are none.
Eigen::Vector2d middle_of(const Image& image, std::size_t channel, const PixelArea& area) {
    Eigen::Vector2d sum(0.0, 0.0);
    double count = 0.0;
    for (int y = 0; y < area.height_px; ++y)
        for (int x = 0; x < area.width_px; ++x) {
            const std::size_t row = image.height_px - 1 - static_cast<std::size_t>(area.y_px + y);
            if (image.rgb[3 * (row * image.width_px + static_cast<std::size_t>(area.x_px + x)) + channel] < 8)
                continue;
            sum += Eigen::Vector2d(x + 0.5, y + 0.5);
            count += 1.0;
        }
    return count > 0.0 ? Eigen::Vector2d(sum / count) : Eigen::Vector2d(-1.0, -1.0);
}

TEST_F(GuiDraw, a_point_lands_on_the_predicted_pixel_of_each_eye_in_every_mode) {
    constexpr int kOutputWidth = 900, kOutputHeight = 600;
    constexpr float kRadiusA = 0.7F;
    ImpostorPrograms programs;
    EyePictures pictures;
    SeededRandom random(21);
    const auto within = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
    const ScreenPlace screen = ScreenPlace::of_size(0.45, 0.30);
    const ScenePlace scene{2e-3, quat_from_rotation_vector(Vec3(0.3, -0.2, 0.1)), Vec3(0.01, -0.02, 0.03)};
    constexpr StereoMode kModes[] = {StereoMode::two_windows, StereoMode::side_by_side,
                                     StereoMode::top_bottom, StereoMode::anaglyph};
    for (int head = 0; head < 20; ++head) {
        const StereoMode mode = kModes[head % 4];
        const Pose pose{Vec3(within(0.25), within(0.2), 0.6 + within(0.2)),
                        quat_from_rotation_vector(Vec3(within(0.4), within(0.4), within(0.2)))};
        const auto eyes = eyes_of(pose, {});
        const Vec3 place_a(within(30.0), within(20.0), within(25.0));
        pictures.resize(mode, kOutputWidth, kOutputHeight);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            pictures.begin(eye, Eigen::Vector3f::Zero());
            const EyeView view = through_screen(screen, scene, eyes[eye], 60.0, Vec3::Zero());
            ImpostorShapes shapes;
            const AtomColours white{{255, 255, 255, 255}, {255, 255, 255, 255}};
            shapes.fill(std::array{Sphere{{static_cast<float>(place_a.x()), static_cast<float>(place_a.y()),
                                           static_cast<float>(place_a.z())},
                                          kRadiusA,
                                          white}});
            programs.use_spheres({view.eye_from_scene, view.projection, haze_});
            shapes.draw();
        }
        const bool each = mode == StereoMode::two_windows;
        const std::vector<Image> shown = pictures.read(each);
        ASSERT_EQ(shown.size(), each ? 2U : 1U);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            const PixelArea area = area_of_eye(mode, eye, kOutputWidth, kOutputHeight);
            // Intersection of the line from eye to position with the glass in z = 0.
            const Vec3 p = scene.to_screen_m(place_a);
            const Vec3 glass = eyes[eye] + eyes[eye].z() / (eyes[eye].z() - p.z()) * (p - eyes[eye]);
            const Eigen::Vector2d wanted((glass.x() / 0.45 + 0.5) * area.width_px,
                                         (glass.y() / 0.30 + 0.5) * area.height_px);
            const Eigen::Vector2d seen = middle_of(shown[each ? eye : 0], eye == 0 ? 0 : 1, area);
            EXPECT_LT((seen - wanted).norm(), 0.5)
                << stereo_mode_text(mode) << ", head " << head << ", eye " << eye;
        }
    }
}

}  // namespace
}  // namespace tact::gui_draw_test
