#include "gui/render/camera.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr float kNearest = 0.05F, kFarthest = 30.0F;  // distance to the target, in radii of the home view

}  // namespace

void Camera::frame(float radius_a) {
    radius_a_ = std::isfinite(radius_a) ? std::clamp(radius_a, 1.0F, 1e13F) : 50.0F;
    home();
}

void Camera::home() {
    target_a_.setZero();
    distance_a_ = 1.06F * radius_a_ / std::sin(0.5F * kFieldOfViewRad);
    // Slightly from above and from the right, to show depth.
    q_eye_scene_ = Eigen::Quaternionf(Eigen::AngleAxisf(0.42F, Eigen::Vector3f::UnitX()) *
                                      Eigen::AngleAxisf(-0.45F, Eigen::Vector3f::UnitY()));
}

void Camera::approach(const Eigen::Vector3f& target_a, float shown_a) {
    if (!target_a.allFinite() || !std::isfinite(shown_a) || target_a.norm() > 4.0F * radius_a_) return;
    target_a_ = target_a;
    distance_a_ = std::clamp(1.06F * shown_a / std::sin(0.5F * kFieldOfViewRad), kNearest * radius_a_,
                             kFarthest * radius_a_);
}

void Camera::place(const Eigen::Vector3f& target_a, const Eigen::Quaternionf& q_eye_scene, float distance_a) {
    if (!target_a.allFinite() || !q_eye_scene.coeffs().allFinite() || !std::isfinite(distance_a) ||
        target_a.norm() > 4.0F * radius_a_ || !(q_eye_scene.norm() > 0.5F))
        return;
    target_a_ = target_a;
    q_eye_scene_ = q_eye_scene.normalized();
    distance_a_ = std::clamp(distance_a, kNearest * radius_a_, kFarthest * radius_a_);
}

void Camera::rotate(float dx_px, float dy_px, float view_height_px) {
    if (!(view_height_px > 0.0F)) return;
    const float per_px = 3.1415927F / view_height_px;  // half a turn over the height of the view
    turn(per_px * Eigen::Vector3f(dy_px, dx_px, 0.0F));
}

void Camera::turn(const Eigen::Vector3f& turn_eye_rad) {
    const float angle = turn_eye_rad.norm();
    if (!(angle > 0.0F) || !std::isfinite(angle)) return;
    q_eye_scene_ =
        (Eigen::Quaternionf(Eigen::AngleAxisf(angle, turn_eye_rad / angle)) * q_eye_scene_).normalized();
}

void Camera::pan(float dx_px, float dy_px, float view_height_px) {
    if (!(view_height_px > 0.0F)) return;
    const float a = a_per_px(view_height_px);
    target_a_ += q_eye_scene_.conjugate() * Eigen::Vector3f(-dx_px * a, dy_px * a, 0.0F);
    const float most = 4.0F * radius_a_;
    if (target_a_.norm() > most) target_a_ *= most / target_a_.norm();
}

void Camera::zoom(float steps) {
    if (!std::isfinite(steps)) return;
    const float factor = std::pow(0.9F, std::clamp(steps, -20.0F, 20.0F));
    distance_a_ = std::clamp(distance_a_ * factor, kNearest * radius_a_, kFarthest * radius_a_);
}

Eigen::Matrix4f Camera::view() const {
    Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
    const Eigen::Matrix3f r = q_eye_scene_.toRotationMatrix();
    m.topLeftCorner<3, 3>() = r;
    m.topRightCorner<3, 1>() = -(r * target_a_) - Eigen::Vector3f(0.0F, 0.0F, distance_a_);
    return m;
}

float Camera::far_a() const { return distance_a_ + target_a_.norm() + 2.5F * radius_a_; }
float Camera::near_a() const {
    return std::max(distance_a_ - target_a_.norm() - 2.5F * radius_a_, 0.002F * far_a());
}

Eigen::Matrix4f Camera::projection(float aspect) const {
    const float f = 1.0F / std::tan(0.5F * kFieldOfViewRad);
    const float n = near_a(), far = far_a();
    Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
    m(0, 0) = f / std::max(aspect, 1e-3F);
    m(1, 1) = f;
    m(2, 2) = (far + n) / (n - far);
    m(2, 3) = 2.0F * far * n / (n - far);
    m(3, 2) = -1.0F;
    return m;
}

float Camera::a_per_px(float view_height_px) const {
    return 2.0F * distance_a_ * std::tan(0.5F * kFieldOfViewRad) / view_height_px;
}

double round_length(double most) {
    if (!(most > 0.0) || !std::isfinite(most)) return 0.0;
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    for (const double step : {5.0, 2.0})
        if (step * power <= most) return step * power;
    return power;
}

}  // namespace tact
