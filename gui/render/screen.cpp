#include "gui/render/screen.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kNearestEyeM = 0.05;
constexpr double kShortestEdgeM = 0.01, kLongestEdgeM = 100.0, kUpright = 0.035;
// As in Camera: depth range about the scene's ball, in its radii, and the least near / far ratio.
constexpr double kBalls = 2.5, kNearShare = 0.002;

}  // namespace

ScreenPlace ScreenPlace::of_size(double width_m, double height_m) {
    const double x = 0.5 * width_m, y = 0.5 * height_m;
    return {Vec3(-x, -y, 0.0), Vec3(x, -y, 0.0), Vec3(-x, y, 0.0)};
}

bool ScreenPlace::possible() const {
    const auto edge = [](double length_m) { return length_m >= kShortestEdgeM && length_m <= kLongestEdgeM; };
    return lower_left_m.allFinite() && lower_right_m.allFinite() && upper_left_m.allFinite() &&
           edge(width_m()) && edge(height_m()) && std::abs(right().dot(up())) < kUpright;
}

ScenePlace orbiting(const Camera& camera, const ScreenPlace& screen) {
    ScenePlace place;
    const double shown_a = 2.0 * static_cast<double>(camera.distance_a()) *
                           std::tan(0.5 * static_cast<double>(Camera::kFieldOfViewRad));
    Eigen::Matrix3d axes;
    axes << screen.right(), screen.up(), screen.towards_viewer();
    place.m_per_a = screen.height_m() / shown_a;
    place.q = Quat(axes) * camera.orientation().cast<double>();
    place.at_m = screen.centre_m() - place.m_per_a * (place.q * camera.target_a().cast<double>());
    return place;
}

ScenePlace in_workspace(double world_per_model, const Vec3& centre_world_m, const Pose& T_screen_world) {
    return {world_per_model * 1e-10, T_screen_world.q,
            T_screen_world.p_m + T_screen_world.q * centre_world_m};
}

std::array<Vec3, 2> eyes_of(const Pose& T_screen_head, const EyesOfHead& eyes) {
    const double half_m = 0.5 * eyes.apart_m * (eyes.swapped ? -1.0 : 1.0);
    const auto at = [&](double x_m) {
        return Vec3(T_screen_head.p_m + T_screen_head.q * (eyes.middle_head_m + Vec3(x_m, 0.0, 0.0)));
    };
    return {at(-half_m), at(half_m)};
}

EyeView through_screen(const ScreenPlace& screen, const ScenePlace& scene, const Vec3& eye_screen_m,
                       double radius_a, const Vec3& target_a) {
    const Vec3 right = screen.right(), towards = screen.towards_viewer(), up = towards.cross(right);
    Vec3 eye_m = eye_screen_m;
    double distance_m = towards.dot(eye_m - screen.lower_left_m);
    if (!(distance_m >= kNearestEyeM)) {
        const double out_m = kNearestEyeM - distance_m;
        eye_m = eye_m.allFinite() ? Vec3(eye_m + out_m * towards)
                                  : Vec3(screen.centre_m() + kNearestEyeM * towards);
        distance_m = kNearestEyeM;
    }
    // The eye frame in ångström: same image, and drawing keeps one unit.
    Eigen::Matrix3d eye_from_screen;
    eye_from_screen << right.transpose(), up.transpose(), towards.transpose();
    Eigen::Matrix4d eye = Eigen::Matrix4d::Identity();
    eye.topLeftCorner<3, 3>() = eye_from_screen * scene.q.toRotationMatrix();
    eye.topRightCorner<3, 1>() = eye_from_screen * (scene.at_m - eye_m) / scene.m_per_a;

    const double middle_a = -eye(2, 3), far_a = std::max(middle_a, 0.0) + kBalls * radius_a,
                 near_a = std::max(middle_a - kBalls * radius_a, kNearShare * far_a);
    const auto slope = [&](const Vec3& axis, const Vec3& corner_m) {
        return axis.dot(corner_m - eye_m) / distance_m;
    };
    const double left = slope(right, screen.lower_left_m), to_right = slope(right, screen.lower_right_m),
                 bottom = slope(up, screen.lower_left_m), top = slope(up, screen.upper_left_m);
    Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
    p(0, 0) = 2.0 / (to_right - left);
    p(0, 2) = (to_right + left) / (to_right - left);
    p(1, 1) = 2.0 / (top - bottom);
    p(1, 2) = (top + bottom) / (top - bottom);
    p(2, 2) = (far_a + near_a) / (near_a - far_a);
    p(2, 3) = 2.0 * far_a * near_a / (near_a - far_a);
    p(3, 2) = -1.0;
    const double looked_a = -(eye.topLeftCorner<3, 3>() * target_a + eye.topRightCorner<3, 1>()).z();
    return {eye.cast<float>(), p.cast<float>(), static_cast<float>(std::max(looked_a, near_a))};
}

}  // namespace tact
