// View of an eye through a screen fixed in the room, so that the scene stays still while the head moves.
//
// Source   off-axis frustum through a rectangle: R. Kooima, Generalized Perspective Projection, 2008.
// Frames   screen: metres, x right, y up, z towards the viewer, with the origin of the corner measurement.
//          Scene: ångström, see Camera. Both eyes look perpendicular to the screen, never toed in.
// Thread   any; plain arithmetic in double precision.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "gui/render/camera.hpp"
#include "gui/render/eye_view.hpp"
#include "ipc/base/pose.hpp"

namespace tact {

struct ScreenPlace {
    Vec3 lower_left_m, lower_right_m, upper_left_m;

    // Upright, centred on the origin.
    static ScreenPlace of_size(double width_m, double height_m);
    [[nodiscard]] Vec3 right() const { return (lower_right_m - lower_left_m).normalized(); }
    [[nodiscard]] Vec3 up() const { return (upper_left_m - lower_left_m).normalized(); }
    [[nodiscard]] Vec3 towards_viewer() const { return right().cross(up()).normalized(); }
    [[nodiscard]] Vec3 centre_m() const { return 0.5 * (lower_right_m + upper_left_m); }
    [[nodiscard]] double width_m() const { return (lower_right_m - lower_left_m).norm(); }
    [[nodiscard]] double height_m() const { return (upper_left_m - lower_left_m).norm(); }
    // True if the edges are 1 cm to 100 m long and perpendicular within two degrees.
    [[nodiscard]] bool possible() const;
};

// Pose and scale of the scene in the room: screen_m = m_per_a * (q * scene_a) + at_m.
struct ScenePlace {
    double m_per_a = 1e-3;
    Quat q = Quat::Identity();
    Vec3 at_m = Vec3::Zero();

    [[nodiscard]] Vec3 to_screen_m(const Vec3& scene_a) const { return m_per_a * (q * scene_a) + at_m; }
};
// As the camera shows it: its target at the centre of the screen, as large as in a window.
[[nodiscard]] ScenePlace orbiting(const Camera& camera, const ScreenPlace& screen);
// In the hand's world, at true size, so that the tool appears at the hand. centre_model_m: the scene's origin.
[[nodiscard]] ScenePlace in_workspace(double world_per_model, const Vec3& centre_world_m,
                                      const Pose& T_screen_world);

struct EyesOfHead {
    double apart_m = 0.064;
    Vec3 middle_head_m = Vec3::Zero();  // between the eyes, in the sensor frame: x towards the right eye
    bool swapped = false;
};
// Left and right eye, screen frame; swapped: reversed.
[[nodiscard]] std::array<Vec3, 2> eyes_of(const Pose& T_screen_head, const EyesOfHead& eyes);

// radius_a: of a ball about the scene's origin that contains it; target_a: the point looked at. An eye closer than 5
// cm to the screen plane, or behind it, is moved to that distance.
[[nodiscard]] EyeView through_screen(const ScreenPlace& screen, const ScenePlace& scene,
                                     const Vec3& eye_screen_m, double radius_a, const Vec3& target_a);

}  // namespace tact
