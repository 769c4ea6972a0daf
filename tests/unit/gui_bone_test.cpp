// Visible bone and instruments; without a display.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "gui/dashboard/axis_cross.hpp"
#include "gui/drilling/bone_field.hpp"
#include "gui/drilling/drill_hands.hpp"
#include "gui/drilling/patient_sides.hpp"
#include "ipc/base/random.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::gui_bone_test {
namespace {

TEST(BoneField, a_soft_labelled_voxel_is_solid_in_proportion_to_its_remaining_density) {
    EXPECT_EQ(solid_of(90, 200, 0), 90) << "unlabelled bone keeps its density";
    EXPECT_EQ(solid_of(90, 200, 3), 90) << "a bony structure keeps its density";
    EXPECT_EQ(solid_of(40, 40, 3), 255);
    EXPECT_EQ(solid_of(20, 40, 3), 127);
    EXPECT_EQ(solid_of(0, 40, 3), 0);
    EXPECT_EQ(solid_of(0, 0, 3), 255) << "invisible in the scan: solid as labelled";
    EXPECT_EQ(solid_of(0, 0, 0), 0);
}

// A box of odd size, and the same while it is drilled.
struct DrilledBox {
    BoneBlock block;
    BoneVolumeView baked, now;
    std::vector<std::uint8_t> drilled = block.density;
    BoneLabelsView labels;
    template <class Solid>
    explicit DrilledBox(const Solid& solid) : block(45, 3e-4, solid, 1) {
        baked.bricks = now.bricks = block.bricks;
        baked.density = block.density;
        now.density = drilled;
    }
    void drill(std::uint32_t brick) {
        std::fill_n(drilled.begin() + brick * BoneBricks::kVoxels, BoneBricks::kVoxels, std::uint8_t{0});
    }
};

struct TwoBalls : DrilledBox {
    TwoBalls()
        : DrilledBox([](const Vec3& p) {
              const double a = 6.0 - (p - Vec3(12.0, 30.0, 9.0)).norm();
              const double b = 9.0 - (p - Vec3(33.0, 33.0, 33.0)).norm();
              return std::clamp(std::max(a, b) + 0.5, 0.0, 1.0);
          }) {}
};

// True if no sample in a cell reaches the surface level, interpolated as on the graphics card.
bool clear_of_surface(const BoneVolumeView& v, std::uint32_t cx, std::uint32_t cy, std::uint32_t cz) {
    const auto at = [&](int x, int y, int z) {
        const auto inside = [&](int i, std::size_t axis) {
            return i >= 0 && i < static_cast<int>(v.bricks.size[axis]);
        };
        if (!inside(x, 0) || !inside(y, 1) || !inside(z, 2)) return 0.0;
        return static_cast<double>(v.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                        static_cast<std::uint32_t>(z)));
    };
    for (int k = 0; k < 9 * 9 * 9; ++k) {
        const Vec3 p(4.0 * cx - 0.5 + 0.5 * (k % 9), 4.0 * cy - 0.5 + 0.5 * (k / 9 % 9),
                     4.0 * cz - 0.5 + 0.5 * (k / 81));
        const Vec3 f = p.array().floor();
        double sum = 0.0;
        for (int c = 0; c < 8; ++c) {
            const Vec3 corner = f + Vec3(c & 1, c >> 1 & 1, c >> 2);
            double w = 1.0;
            for (int axis = 0; axis < 3; ++axis) w *= 1.0 - std::fabs(p[axis] - corner[axis]);
            sum += w * at(static_cast<int>(corner.x()), static_cast<int>(corner.y()),
                          static_cast<int>(corner.z()));
        }
        if (sum >= BoneField::kSurface) return false;
    }
    return true;
}

void expect_true_distances(const BoneField& field, const BoneVolumeView& now) {
    const auto [nx, ny, nz] = field.cells();
    std::vector<std::uint8_t> clear;
    for (std::uint32_t z = 0; z < nz; ++z)
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t x = 0; x < nx; ++x) clear.push_back(clear_of_surface(now, x, y, z) ? 1 : 0);
    std::size_t far = 0;
    for (std::uint32_t z = 0; z < nz; ++z)
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t x = 0; x < nx; ++x) {
                const int k = field.free_cells()[(std::size_t{z} * ny + y) * nx + x];
                far += k > 2 ? 1 : 0;
                // All cells nearer than k contain no surface.
                for (int dz = 1 - k; dz < k; ++dz)
                    for (int dy = 1 - k; dy < k; ++dy)
                        for (int dx = 1 - k; dx < k; ++dx) {
                            const int ax = static_cast<int>(x) + dx, ay = static_cast<int>(y) + dy,
                                      az = static_cast<int>(z) + dz;
                            if (ax < 0 || ay < 0 || az < 0 || ax >= static_cast<int>(nx) ||
                                ay >= static_cast<int>(ny) || az >= static_cast<int>(nz))
                                continue;
                            const auto at = static_cast<std::uint32_t>(
                                (az * static_cast<int>(ny) + ay) * static_cast<int>(nx) + ax);
                            ASSERT_NE(clear[at], 0) << x << "," << y << "," << z << " has distance " << k;
                        }
            }
    EXPECT_GT(far, 50U) << "large steps must be possible";
}

// A segmented volume of voxels that are bone or not: a ball, a plate of one voxel, and a cavity whose corners smoothing
// rounds into the cell inside.
struct Segmented : DrilledBox {
    Segmented()
        : DrilledBox([](const Vec3& p) {
              const bool ball = (p - Vec3(20.0, 22.0, 24.0)).norm() < 11.0;
              const bool plate = std::abs(p.z() - 40.0) < 0.4;
              const bool cube = p.maxCoeff() < 11.5;
              const bool cavity = p.minCoeff() > 2.5 && p.maxCoeff() < 8.5;
              return ball || plate || (cube && !cavity) ? 1.0 : 0.0;
          }) {}
    // As shown: all 125 voxels around each, weighted at once.
    [[nodiscard]] double smoothed(int x, int y, int z) const {
        constexpr std::array<double, 5> kWeight{1.0, 4.0, 6.0, 4.0, 1.0};
        double sum = 0.0;
        for (int c = -2; c <= 2; ++c)
            for (int b = -2; b <= 2; ++b)
                for (int a = -2; a <= 2; ++a) {
                    const std::array<int, 3> at{x + a, y + b, z + c};
                    if (std::any_of(at.begin(), at.end(), [](int i) { return i < 0 || i >= 45; })) continue;
                    sum += kWeight[static_cast<std::size_t>(a + 2)] *
                           kWeight[static_cast<std::size_t>(b + 2)] *
                           kWeight[static_cast<std::size_t>(c + 2)] / 4096.0 *
                           now.at(static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]),
                                  static_cast<std::uint32_t>(at[2]));
                }
        return sum;
    }
};

TEST(BoneField, a_segmented_volume_is_shown_smooth_and_a_scan_as_it_is) {
    TwoBalls scan;
    EXPECT_FALSE(BoneField(scan.baked, scan.labels, scan.now).smooth());
    Segmented s;
    const BoneField field(s.baked, s.labels, s.now);
    ASSERT_TRUE(field.smooth());
    const auto n = s.block.bricks.bricks();
    std::array<std::uint8_t, BoneBricks::kVoxels> shown{};
    int between = 0;
    for (std::uint32_t b = 0; b < s.block.bricks.brick_count(); ++b) {
        field.solids(b, shown);
        for (int i = 0; i < 512; ++i) {
            const int x = static_cast<int>(b % n[0]) * 8 + i % 8,
                      y = static_cast<int>(b / n[0] % n[1]) * 8 + i / 8 % 8,
                      z = static_cast<int>(b / n[0] / n[1]) * 8 + i / 64;
            if (x >= 45 || y >= 45 || z >= 45) continue;
            const int value = shown[static_cast<std::size_t>(i)];
            ASSERT_NEAR(value, s.smoothed(x, y, z), 2.0) << x << "," << y << "," << z;
            between += value > 20 && value < 235 ? 1 : 0;
        }
    }
    EXPECT_GT(between, 1000);
    // A plate of one voxel does not vanish.
    field.solids(static_cast<std::uint32_t>(s.block.bricks.brick(4, 4, 40)), shown);
    EXPECT_GE(shown[(0 * 8 + 4) * 8 + 4], BoneField::kSurface);
}

TEST(BoneField, a_brick_in_the_middle_of_solid_bone_is_smoothed_once_it_is_cut) {
    Segmented s;
    std::fill(s.block.density.begin(), s.block.density.end(), std::uint8_t{255});
    std::fill(s.drilled.begin(), s.drilled.end(), std::uint8_t{255});
    BoneField field(s.baked, s.labels, s.now);
    const auto brick = static_cast<std::uint32_t>(s.block.bricks.brick(20, 20, 20));
    std::array<std::uint8_t, BoneBricks::kVoxels> shown{};
    field.solids(brick, shown);
    EXPECT_EQ(*std::min_element(shown.begin(), shown.end()), 255);
    for (std::size_t i = 0; i < BoneBricks::kVoxels; ++i)
        if (i % 8 < 4) s.drilled[brick * BoneBricks::kVoxels + i] = 0;
    field.changed(brick);
    field.solids(brick, shown);
    for (int x = 0; x < 8; ++x)
        EXPECT_NEAR(shown[static_cast<std::size_t>(4 * 64 + 4 * 8 + x)], s.smoothed(16 + x, 20, 20), 2.0)
            << x;
}

TEST(BoneField, distances_stay_true_in_a_segmented_volume_while_bone_goes_and_comes_back) {
    Segmented s;
    BoneField field(s.baked, s.labels, s.now);
    const auto check = [&] {
        std::vector<std::uint8_t> shown(s.block.bricks.bytes());
        for (std::uint32_t b = 0; b < s.block.bricks.brick_count(); ++b)
            field.solids(b, std::span<std::uint8_t, BoneBricks::kVoxels>(
                                shown.data() + b * BoneBricks::kVoxels, BoneBricks::kVoxels));
        BoneVolumeView view = s.now;
        view.density = shown;
        expect_true_distances(field, view);
    };
    check();
    // A brick in the ball goes, then others, and all come back.
    const std::array<std::uint32_t, 3> bricks{static_cast<std::uint32_t>(s.block.bricks.brick(20, 22, 24)),
                                              static_cast<std::uint32_t>(s.block.bricks.brick(28, 22, 24)),
                                              static_cast<std::uint32_t>(s.block.bricks.brick(20, 30, 30))};
    for (const std::uint32_t b : bricks) {
        s.drill(b);
        field.changed(b);
        check();
    }
    for (const std::uint32_t b : bricks) {
        std::copy_n(s.block.density.begin() + b * BoneBricks::kVoxels, BoneBricks::kVoxels,
                    s.drilled.begin() + b * BoneBricks::kVoxels);
        field.changed(b, true);
        static_cast<void>(field.settle());
        check();
    }
}

TEST(BoneField, free_cells_contain_no_surface) {
    const TwoBalls two;
    const BoneField field(two.baked, two.labels, two.now);
    expect_true_distances(field, two.now);
}

TEST(BoneField, drilled_cells_open_and_restored_bone_is_detected) {
    TwoBalls two;
    BoneField field(two.baked, two.labels, two.now);
    const std::size_t middle = (std::size_t{8} * field.cells()[1] + 8) * field.cells()[0] + 8;
    EXPECT_EQ(field.free_cells()[middle], 0);
    const std::vector<std::uint8_t> whole = two.drilled;
    for (std::uint32_t b = 0; b < two.block.bricks.brick_count(); ++b) {
        two.drill(b);
        field.changed(b);
        EXPECT_FALSE(field.settle());
    }
    // In the first round, bricks were next to undrilled ones; in the second all space is open.
    for (std::uint32_t b = 0; b < two.block.bricks.brick_count(); ++b) field.changed(b);
    EXPECT_GE(field.free_cells()[middle], 1);
    std::copy(whole.begin(), whole.end(), two.drilled.begin());
    for (std::uint32_t b = 0; b < two.block.bricks.brick_count(); ++b) field.changed(b, true);
    EXPECT_TRUE(field.settle());
    EXPECT_EQ(field.free_cells()[middle], 0);
    expect_true_distances(field, two.now);
}

// Bricks are drilled and restored at random; cells are never farther from bone than they say.
TEST(BoneField, distances_stay_true_while_bone_goes_and_comes_back) {
    TwoBalls two;
    const std::vector<std::uint8_t> whole = two.drilled;
    SeededRandom random(11);
    const auto bricks = static_cast<std::uint32_t>(two.block.bricks.brick_count());
    for (std::uint32_t b = 0; b < bricks; ++b)
        if (random.below(4) != 0) two.drill(b);
    BoneField field(two.baked, two.labels, two.now);  // far from most of the bone
    int shortened = 0;
    for (int round = 0; round < 12; ++round) {
        for (int k = 0; k < 40; ++k) {
            const auto b = static_cast<std::uint32_t>(random.below(bricks));
            const bool grows = random.below(3) == 0;
            if (grows) {
                const auto first = static_cast<std::ptrdiff_t>(b * BoneBricks::kVoxels);
                std::copy_n(whole.begin() + first, BoneBricks::kVoxels, two.drilled.begin() + first);
            } else {
                two.drill(b);
            }
            field.changed(b, grows);
        }
        shortened += field.settle() ? 1 : 0;
        expect_true_distances(field, two.now);
    }
    EXPECT_GT(shortened, 3);
}

double farthest(const TubeMesh& mesh, double z_most) {
    double most = 0.0;
    for (const TubeVertex& v : mesh.vertex)
        if (static_cast<double>(v.position_a[2]) <= z_most)
            most = std::max(most, std::sqrt(static_cast<double>(v.position_a[0] * v.position_a[0] +
                                                                v.position_a[1] * v.position_a[1] +
                                                                v.position_a[2] * v.position_a[2])));
    return most;
}

TEST(DrillTools, a_drawn_head_has_the_size_of_the_tool_and_outward_normals) {
    DrawnDrillTool tool;
    tool.radius_m = 3e-9;  // 30 ångström
    tool.length_m = 6e-9;
    tool.tip_radius_m = 3e-9;
    const TubeMesh ball = build_drill_tool(tool).head;
    ASSERT_FALSE(ball.vertex.empty());
    EXPECT_NEAR(farthest(ball, 1e9), 30.0, 0.05);
    for (const TubeVertex& v : ball.vertex) {
        const Eigen::Vector3f p(v.position_a[0], v.position_a[1], v.position_a[2]);
        const Eigen::Vector3f n(v.normal[0], v.normal[1], v.normal[2]);
        if (p.head<2>().norm() > 3.0F) {
            EXPECT_GT(n.dot(p.normalized()), 0.3F);
        }
        EXPECT_GT(p.norm(), 30.0F * 0.88F);
    }
    for (const std::uint32_t i : ball.index) ASSERT_LT(i, ball.vertex.size());
    tool.shaft_radius_m = 1e-9;
    tool.shaft_length_m = 25e-9;
    const TubeMesh with_shaft = build_drill_tool(tool).rest;
    EXPECT_NEAR(farthest(build_drill_tool(tool).head, 1e9), 30.0, 0.05);
    EXPECT_GT(farthest(with_shaft, 1e9), 250.0);
    tool.diamond = true;  // grains, no grooves
    for (const TubeVertex& v : build_drill_tool(tool).head.vertex)
        ASSERT_NEAR(Eigen::Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]).norm(), 30.0F, 0.01F);
    tool.diamond = false;
    tool.head = DrillHead::cylinder;
    tool.length_m = 12e-9;
    const TubeMesh rod = build_drill_tool(tool).head;
    EXPECT_NEAR(farthest(rod, 0.0), 60.0, 0.5) << "half of its length";
    tool.head = DrillHead::tube;
    EXPECT_FALSE(build_drill_tool(tool).rest.index.empty());
    EXPECT_TRUE(build_drill_tool(tool).head.index.empty());
    tool.radius_m = 0.0;
    EXPECT_TRUE(build_drill_tool(tool).rest.index.empty());
}

TEST(DrillHands, tools_are_drawn_in_model_units_and_rotate_only_when_driven) {
    DrillTopic topic{};
    SceneMeta meta{};
    meta.world_per_model = 2.0;
    DrillHands hands;
    EXPECT_TRUE(hands.follow(topic, meta).empty());
    topic.hand[1].kind = DrillKind::suction_tube;
    topic.hand[1].radius_m = 1e-3F;
    topic.hand[1].quat_model_tool_xyzw[3] = 1.0;
    topic.hand[1].pos_model_m[2] = 0.5;
    auto drawn = hands.follow(topic, meta);
    ASSERT_EQ(drawn.size(), 1U);
    EXPECT_EQ(drawn[0].head, DrillHead::tube);
    EXPECT_NEAR(drawn[0].radius_m, 5e-4, 1e-9);
    EXPECT_EQ(drawn[0].T_model_tool.p_m.z(), 0.5);
    topic.hand[0] = topic.hand[1];
    topic.hand[0].kind = DrillKind::burr;
    topic.hand[0].shape = DrillShape::cone;
    drawn = hands.follow(topic, meta);
    ASSERT_EQ(drawn.size(), 2U);
    EXPECT_EQ(drawn[0].head, DrillHead::cone);
    EXPECT_EQ(drawn[0].turned_rad, 0.0);
    topic.hand[0].burr_rad_s = 6000.0F;
    const double once = hands.follow(topic, meta)[0].turned_rad;
    const double twice = hands.follow(topic, meta)[0].turned_rad;
    EXPECT_GT(once, 0.0);
    EXPECT_GT(twice, once);
    EXPECT_EQ(hands.follow(topic, meta)[1].turned_rad, 0.0);
}

// Any camera on any oblique scan: the letters point to where a step to that side of the patient goes on the screen.
TEST(AxisCross, letters_point_to_the_patients_sides) {
    SeededRandom random(5);
    const auto turn = [&] {
        return Eigen::Matrix3d(
            Eigen::AngleAxisd(3.0 * random.uniform(), random.direction()).toRotationMatrix());
    };
    for (int n = 0; n < 50; ++n) {
        PatientFrame frame;
        frame.axes = turn();
        frame.origin_mm = Vec3(40.0, -3.0, 700.0);
        const Eigen::Matrix3d eye_from_model = turn();
        float eye_axes[3][3];  // of each model axis
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) eye_axes[i][k] = static_cast<float>(eye_from_model(k, i));
        SceneState scene;
        show_sides(frame, scene);
        const std::vector<AxisEnd> ends = axis_cross(eye_axes, scene);
        ASSERT_EQ(ends.size(), 6U);
        const Vec3 here(31.0, 8.0, 690.0);  // LPS
        const std::map<std::string, Vec3> sides{{"L", Vec3(10, 0, 0)}, {"R", Vec3(-10, 0, 0)},
                                                {"P", Vec3(0, 10, 0)}, {"A", Vec3(0, -10, 0)},
                                                {"H", Vec3(0, 0, 10)}, {"F", Vec3(0, 0, -10)}};
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const Vec3 way = 100.0 * (eye_from_model *
                                      (frame.model_m(here + sides.at(ends[i].name)) - frame.model_m(here)));
            EXPECT_NEAR(ends[i].x, way.x(), 1e-5) << ends[i].name;
            EXPECT_NEAR(ends[i].y, way.y(), 1e-5) << ends[i].name;
            EXPECT_NEAR(ends[i].depth, way.z(), 1e-5) << ends[i].name;
            if (i > 0) {
                EXPECT_LE(ends[i - 1].depth, ends[i].depth);
            }
        }
    }
}

TEST(AxisCross, without_a_patient_it_is_that_of_the_scene) {
    const float eye_axes[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    SceneState scene;
    show_sides(std::nullopt, scene);
    const std::vector<AxisEnd> ends = axis_cross(eye_axes, scene);
    ASSERT_EQ(ends.size(), 3U);
    EXPECT_STREQ(ends[2].name, "x");  // towards the eye
    for (const AxisEnd& end : ends) EXPECT_FALSE(end.negative);
}

}  // namespace
}  // namespace tact::gui_bone_test
