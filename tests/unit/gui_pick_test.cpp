// A click on a body in the view: which one the line of sight meets.
#include <gtest/gtest.h>

#include "gui/docking/body_pick.hpp"
#include "ipc/base/units.hpp"

namespace tact::gui_pick_test {
namespace {

Structure rod(std::size_t atoms) {  // along x, 1 A apart, about the origin
    Structure s;
    for (std::size_t i = 0; i < atoms; ++i) {
        s.x_m.push_back(
            static_cast<float>((static_cast<double>(i) - 0.5 * static_cast<double>(atoms - 1)) * kAngstromM));
        s.y_m.push_back(0.0F);
        s.z_m.push_back(0.0F);
    }
    return s;
}

ShownBody at(double x_a, double y_a, double z_a, std::uint16_t structure = 0) {
    ShownBody body;
    body.structure = structure;
    body.T_model_body = {kAngstromM * Vec3(x_a, y_a, z_a), Quat::Identity()};
    return body;
}

// From 100 A above, downwards; a pixel is 0.001 of the depth.
Sight from_above(double x_a, double y_a) {
    return {kAngstromM * Vec3(x_a, y_a, 100.0), Vec3(0.0, 0.0, -1.0), 0.0, 1e-3};
}

TEST(BodyPick, takes_the_nearest_body_on_the_line_of_sight) {
    const std::vector<Structure> structures{rod(21)};
    std::vector<ShownBody> bodies{at(0, 0, 0), at(0, 0, 10), at(0, 30, 0)};
    EXPECT_EQ(body_along(from_above(0, 0), bodies, structures), 1U);
    EXPECT_EQ(body_along(from_above(9, 31), bodies, structures), 2U);
    EXPECT_EQ(body_along(from_above(0, 15), bodies, structures), std::nullopt);
    EXPECT_EQ(body_along(from_above(13, 0), bodies, structures), std::nullopt);  // beyond the end
    bodies[1].hidden = true;
    EXPECT_EQ(body_along(from_above(0, 0), bodies, structures), 0U);
    // What a cut or the eye leaves behind cannot be pointed at.
    bodies[1].hidden = false;
    Sight cut = from_above(0, 0);
    cut.near_m = 95.0 * kAngstromM;
    EXPECT_EQ(body_along(cut, bodies, structures), 0U);
    cut.near_m = 0.0;
    cut.way = Vec3(0.0, 0.0, 1.0);
    EXPECT_EQ(body_along(cut, bodies, structures), std::nullopt);
}

TEST(BodyPick, follows_the_pose_of_a_body_and_gives_far_atoms_some_pixels) {
    const std::vector<Structure> structures{rod(21)};
    std::vector<ShownBody> bodies{at(0, 0, 0)};
    EXPECT_EQ(body_along(from_above(0, 9), bodies, structures), std::nullopt);
    bodies[0].T_model_body.q = quat_from_rotation_vector(Vec3(0.0, 0.0, 1.5707963));  // along y
    EXPECT_EQ(body_along(from_above(0, 9), bodies, structures), 0U);
    EXPECT_EQ(body_along(from_above(9, 0), bodies, structures), std::nullopt);
    Sight far = from_above(4, 0);
    EXPECT_EQ(body_along(far, bodies, structures), std::nullopt);
    far.px_share = 0.01;  // 5 pixels are 5 A
    EXPECT_EQ(body_along(far, bodies, structures), 0U);
}

TEST(BodyPick, survives_bodies_that_the_scene_does_not_have_and_no_direction) {
    const std::vector<Structure> structures{rod(3)};
    const std::vector<ShownBody> bodies{at(0, 0, 0, 7)};
    EXPECT_EQ(body_along(from_above(0, 0), bodies, structures), std::nullopt);
    Sight none = from_above(0, 0);
    none.way = Vec3::Zero();
    EXPECT_EQ(body_along(none, std::vector<ShownBody>{at(0, 0, 0)}, structures), std::nullopt);
}

}  // namespace
}  // namespace tact::gui_pick_test
