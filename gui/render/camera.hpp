// Orbit camera about a target, moved by the mouse as in other map viewers.
//
// Unit     ångström, float: the scene frame is (model - centre of the scene) * 1e10, which keeps the numbers
//          small enough for graphics. Axes are those of the model: x right, y up, z to the user.
// Thread   any; plain arithmetic.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gui/render/eye_view.hpp"

namespace tact {

class Camera {
public:
    static constexpr float kFieldOfViewRad = 0.6F;  // vertical

    // Sets the home view, a ball of this radius about the origin, and goes there at once.
    void frame(float radius_a);
    void home();
    // Moves to a target and keeps the orientation: a ball of radius `shown_a` fills the view. Ignores non-finite
    // values.
    void approach(const Eigen::Vector3f& target_a, float shown_a);

    // Restores target_a(), orientation() and distance_a(). Ignores non-finite values and targets too far away.
    void place(const Eigen::Vector3f& target_a, const Eigen::Quaternionf& q_eye_scene, float distance_a);

    // Mouse motion in pixels in a view of this height; y points down.
    void rotate(float dx_px, float dy_px, float view_height_px);
    void pan(float dx_px, float dy_px, float view_height_px);
    // By a rotation vector in the eye's axes.
    void turn(const Eigen::Vector3f& turn_eye_rad);
    void zoom(float steps);  // positive: closer, ten per cent a step

    [[nodiscard]] Eigen::Matrix4f view() const;  // scene -> eye, the eye looks along -z
    [[nodiscard]] Eigen::Matrix4f projection(float aspect) const;
    [[nodiscard]] EyeView eye(float aspect) const { return {view(), projection(aspect), distance_a_}; }
    [[nodiscard]] Eigen::Quaternionf orientation() const { return q_eye_scene_; }
    [[nodiscard]] Eigen::Vector3f target_a() const { return target_a_; }
    [[nodiscard]] float distance_a() const { return distance_a_; }
    [[nodiscard]] Eigen::Vector3f eye_a() const {
        return target_a_ + q_eye_scene_.conjugate() * Eigen::Vector3f(0.0F, 0.0F, distance_a_);
    }
    [[nodiscard]] float near_a() const;
    [[nodiscard]] float far_a() const;
    [[nodiscard]] float radius_a() const { return radius_a_; }
    // Length of one pixel at the target.
    [[nodiscard]] float a_per_px(float view_height_px) const;

private:
    float radius_a_ = 50.0F;
    float distance_a_ = 200.0F;
    Eigen::Vector3f target_a_ = Eigen::Vector3f::Zero();
    Eigen::Quaternionf q_eye_scene_ = Eigen::Quaternionf::Identity();
};

// 1, 2 or 5 times a power of ten, the largest not above `most`; 0 unless `most` is positive and finite.
[[nodiscard]] double round_length(double most);

}  // namespace tact
