// Camera, backbone tubes and the force arrow: their geometry, without a graphics card.
#include <gtest/gtest.h>

#include <cmath>

#include "gui/docking/docking_layer.hpp"
#include "gui/render/arrow.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/mesh_pace.hpp"
#include "gui/render/tube.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_view_test {
namespace {

Eigen::Vector3f on_screen(const Camera& camera, const Eigen::Vector3f& p, float aspect) {
    const Eigen::Vector4f clip = camera.projection(aspect) * camera.view() * p.homogeneous();
    return clip.head<3>() / clip.w();
}

TEST(MeshPace, the_budget_shrinks_at_once_after_slow_moves_and_grows_slowly) {
    MeshPace pace;
    EXPECT_DOUBLE_EQ(pace.budget_ns(0.002), 2e6);
    pace.took(1e6, 4e-3);
    EXPECT_DOUBLE_EQ(pace.budget_ns(0.002), 0.5e6);
    pace.took(1e6, 1e-3);
    EXPECT_NEAR(pace.slower(), 3.7, 1e-12);
    pace.took(100.0, 1.0);  // too short a prediction to judge by
    EXPECT_NEAR(pace.slower(), 3.7, 1e-12);
    for (int i = 0; i < 200; ++i) pace.took(1e6, 0.0);
    EXPECT_NEAR(pace.slower(), 0.25, 1e-3);
    pace.took(1e6, 1e9);
    EXPECT_EQ(pace.slower(), 16.0);
}

TEST(Camera, home_shows_the_whole_ball_centred) {
    Camera camera;
    camera.frame(80.0F);
    EXPECT_LT(on_screen(camera, Eigen::Vector3f::Zero(), 1.5F).head<2>().norm(), 1e-5F);
    for (int i = 0; i < 200; ++i) {
        const float a = 0.7F * static_cast<float>(i), z = -1.0F + 0.01F * static_cast<float>(i);
        const float r = std::sqrt(1.0F - z * z);
        const Eigen::Vector3f p =
            on_screen(camera, 80.0F * Eigen::Vector3f(r * std::cos(a), r * std::sin(a), z), 1.5F);
        EXPECT_LT(p.cwiseAbs().maxCoeff(), 1.0F);
    }
}

TEST(Camera, approaching_a_point_centres_it_without_rotation) {
    Camera camera;
    camera.frame(50.0F);
    const Eigen::Quaternionf before = camera.orientation();
    const Eigen::Vector3f place(10.0F, -20.0F, 5.0F);
    camera.approach(place, 5.0F);
    EXPECT_TRUE(camera.orientation().isApprox(before));
    EXPECT_LT(on_screen(camera, place, 1.5F).head<2>().norm(), 1e-4F);
    // A ball of radius 5 around it almost fills the height.
    const Eigen::Vector3f up = camera.orientation().conjugate() * Eigen::Vector3f(0.0F, 5.0F, 0.0F);
    const float edge = on_screen(camera, place + up, 1.5F).y();
    EXPECT_GT(edge, 0.8F);
    EXPECT_LT(edge, 1.0F);
    const float distance = camera.distance_a();
    camera.approach(Eigen::Vector3f::Constant(std::nanf("")), 5.0F);
    camera.approach(Eigen::Vector3f::Constant(1e9F), 5.0F);
    EXPECT_EQ(camera.distance_a(), distance);
    EXPECT_EQ(camera.target_a(), place);
}

TEST(Camera, dragging_moves_the_scene_with_the_mouse) {
    Camera camera;
    camera.frame(50.0F);
    camera.home();
    const float height = 600.0F;
    // Pan: the target moves by as many pixels as the mouse.
    const Eigen::Vector3f before = on_screen(camera, Eigen::Vector3f::Zero(), 1.0F);
    camera.pan(30.0F, -12.0F, height);
    const Eigen::Vector3f after = on_screen(camera, Eigen::Vector3f::Zero(), 1.0F);
    EXPECT_NEAR((after.x() - before.x()) * 0.5F * height, 30.0F, 0.1F);
    EXPECT_NEAR((after.y() - before.y()) * 0.5F * height, 12.0F, 0.1F);
    // Rotate: a point in front moves to the right when the mouse moves right.
    camera.home();
    const Eigen::Vector3f front = camera.orientation().conjugate() * Eigen::Vector3f(0.0F, 0.0F, 40.0F);
    camera.rotate(50.0F, 0.0F, height);
    EXPECT_GT(on_screen(camera, front, 1.0F).x(), 0.05F);
    camera.home();
    camera.rotate(0.0F, 50.0F, height);  // the mouse moves down
    EXPECT_LT(on_screen(camera, front, 1.0F).y(), -0.05F);
}

TEST(Camera, a_drag_over_the_view_height_is_half_a_turn_and_stays_a_unit_rotation) {
    Camera camera;
    const Eigen::Quaternionf before = camera.orientation();
    for (int i = 0; i < 600; ++i) camera.rotate(1.0F, 0.0F, 600.0F);
    EXPECT_NEAR(before.angularDistance(camera.orientation()), 3.14159F, 1e-3F);
    EXPECT_NEAR(camera.orientation().norm(), 1.0F, 1e-5F);
}

TEST(Camera, zoom_moves_closer_and_stays_in_bounds) {
    Camera camera;
    camera.frame(50.0F);
    const float at_home = camera.distance_a();
    camera.zoom(1.0F);
    EXPECT_NEAR(camera.distance_a(), 0.9F * at_home, 1e-2F);
    for (int i = 0; i < 1000; ++i) camera.zoom(1.0F);
    EXPECT_GT(camera.distance_a(), 0.0F);
    EXPECT_GT(camera.near_a(), 0.0F);
    EXPECT_GT(camera.far_a(), camera.near_a());
    for (int i = 0; i < 1000; ++i) camera.zoom(-1.0F);
    EXPECT_LE(camera.distance_a(), 30.0F * 50.0F);
    camera.zoom(std::nanf(""));
    EXPECT_TRUE(std::isfinite(camera.distance_a()));
    camera.home();
    EXPECT_FLOAT_EQ(camera.distance_a(), at_home);
}

TEST(Camera, the_length_of_a_pixel_at_the_target_is_correct) {
    Camera camera;
    camera.frame(50.0F);
    const float height = 480.0F;
    const Eigen::Vector3f right = camera.orientation().conjugate() * Eigen::Vector3f(10.0F, 0.0F, 0.0F);
    const float px = on_screen(camera, right, 1.0F).x() * 0.5F * height;
    EXPECT_NEAR(10.0F / px, camera.a_per_px(height), 1e-3F);
}

TEST(RoundLength, is_one_two_or_five_and_never_above_the_argument) {
    EXPECT_DOUBLE_EQ(round_length(47.0), 20.0);
    EXPECT_DOUBLE_EQ(round_length(50.0), 50.0);
    EXPECT_DOUBLE_EQ(round_length(0.19), 0.1);
    EXPECT_DOUBLE_EQ(round_length(9.99), 5.0);
    EXPECT_EQ(round_length(0.0), 0.0);
    EXPECT_EQ(round_length(std::nan("")), 0.0);
}

TEST(Tubes, pass_through_every_trace_atom_and_break_where_the_chain_changes) {
    const Structure s = fake::helix(20);
    const TubeMesh mesh = build_tubes(s, 100'000);
    EXPECT_EQ(mesh.strands, 2U);
    for (std::size_t i = 0; i < s.size(); ++i) {
        float nearest = 1e9F;
        for (const TubeVertex& v : mesh.vertex)
            nearest = std::min(nearest, (Eigen::Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]) -
                                         1e10F * Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]))
                                            .norm());
        EXPECT_LT(nearest, 0.8F) << i;  // the radius of a tube
    }
    for (const std::uint32_t i : mesh.index) ASSERT_LT(i, mesh.vertex.size());
}

TEST(Tubes, normals_are_unit_and_triangles_face_outward) {
    const TubeMesh mesh = build_tubes(fake::helix(12), 100'000);
    ASSERT_FALSE(mesh.index.empty());
    const auto at = [&](std::uint32_t i) { return Eigen::Vector3f(mesh.vertex[i].position_a); };
    const auto normal = [&](std::uint32_t i) { return Eigen::Vector3f(mesh.vertex[i].normal); };
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
        const auto [a, b, c] = std::tuple{mesh.index[t], mesh.index[t + 1], mesh.index[t + 2]};
        const Eigen::Vector3f face = (at(b) - at(a)).cross(at(c) - at(a));
        EXPECT_NEAR(normal(a).norm(), 1.0F, 1e-4F);
        EXPECT_GE(face.dot(normal(a) + normal(b) + normal(c)), -1e-6F) << t / 3;
    }
}

TEST(Tubes, stay_within_the_vertex_limit) {
    for (const std::size_t atoms : {10U, 300U, 3000U}) {
        const TubeMesh mesh = build_tubes(fake::helix(atoms), 20'000);
        EXPECT_LE(mesh.vertex.size(), 20'000U + 2U * 9U) << atoms;
    }
}

TEST(Tubes, a_structure_without_a_trace_has_no_tubes) {
    Structure s = fake::helix(10);
    std::fill(s.trace.begin(), s.trace.end(), std::uint8_t{0});
    EXPECT_TRUE(build_tubes(s, 1000).vertex.empty());
    s.trace[3] = 1;  // a lone atom
    EXPECT_TRUE(build_tubes(s, 1000).vertex.empty());
}

TEST(Arrow, points_from_the_body_along_the_force_with_outward_faces) {
    const Eigen::Vector3f from(1.0F, 2.0F, 3.0F), along(0.0F, 0.0F, 20.0F);
    const TubeMesh mesh = build_arrow(from, along, 1.0F, {255, 0, 0});
    float low = 1e9F, high = -1e9F;
    for (const TubeVertex& v : mesh.vertex) {
        low = std::min(low, v.position_a[2]);
        high = std::max(high, v.position_a[2]);
    }
    EXPECT_NEAR(low, 3.0F, 1e-4F);
    EXPECT_NEAR(high, 23.0F, 1e-4F);
    const auto at = [&](std::uint32_t i) { return Eigen::Vector3f(mesh.vertex[i].position_a); };
    double volume = 0.0;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3)
        volume +=
            static_cast<double>(at(mesh.index[t]).dot(at(mesh.index[t + 1]).cross(at(mesh.index[t + 2])))) /
            6.0;
    EXPECT_GT(volume, 0.0);  // a closed surface whose faces point outward
    EXPECT_TRUE(build_arrow(from, 0.5F * along.normalized(), 1.0F, {255, 0, 0}).vertex.empty());
    EXPECT_TRUE(build_arrow(from, along * std::nanf(""), 1.0F, {255, 0, 0}).vertex.empty());
}

TEST(CodebookLevel, is_the_largest_legible_one_within_the_points_of_the_force) {
    Codebook book;
    for (const std::size_t n : {25U, 50U, 100U, 400U, 800U}) {
        Codebook::Level level;
        level.x_m.resize(n);
        book.levels.push_back(level);
    }
    EXPECT_EQ(codebook_level(book, 0), 0U);
    EXPECT_EQ(codebook_level(book, 49), 0U);
    EXPECT_EQ(codebook_level(book, 50), 1U);
    EXPECT_EQ(codebook_level(book, 70), 1U);
    EXPECT_EQ(codebook_level(book, 100), 2U);
    EXPECT_EQ(codebook_level(book, 100'000), 3U) << "400 vectors";
}

}  // namespace
}  // namespace tact::gui_view_test
