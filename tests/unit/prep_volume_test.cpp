// From scans to a bone scene: synthetic bone, distances, readers, errors.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "prep/drilling/approach.hpp"
#include "prep/drilling/bake_bone.hpp"
#include "prep/drilling/distance.hpp"
#include "prep/synthetic/temporal_bone.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::prep_volume_test {
namespace {

// Brute force: distance of a point (in voxels) to the surface of all voxel cubes with the label.
double slow_distance(const BoneData& b, std::uint8_t of, const Vec3& p) {
    double outside = 1e30, inside = 1e30;
    const auto& n = b.bricks.size;
    for (std::uint32_t z = 0; z < n[2]; ++z)
        for (std::uint32_t y = 0; y < n[1]; ++y)
            for (std::uint32_t x = 0; x < n[0]; ++x) {
                const Vec3 gap = ((p - Vec3(x, y, z)).cwiseAbs() - Vec3(0.5, 0.5, 0.5)).cwiseMax(0.0);
                double& least = b.label[b.bricks.voxel(x, y, z)] == of ? outside : inside;
                least = std::min(least, gap.norm());
            }
    return outside > 0.0 ? outside : -inside;
}

BoneData made(std::uint32_t voxels, std::uint64_t seed = 1) {
    return make_temporal_bone({.voxels = voxels, .voxel_m = 1e-3, .seed = seed});
}
// Made once, because sanitizers are slow.
const BoneData& made_64() {
    static const BoneData bone = made(64);
    return bone;
}

TEST(MadeTemporalBone, repeats_and_its_seed_affects_only_cells_and_roughness) {
    const BoneData bone = made(32), other = made(32, 2);
    EXPECT_EQ(bone.density, made(32).density);
    EXPECT_NE(bone.density, other.density);
    for (std::size_t i = 0; i < bone.label.size(); ++i) {
        if (bone.label[i] == static_cast<std::uint8_t>(EarPart::sigmoid_sinus)) {
            EXPECT_EQ(other.label[i], bone.label[i]);
        }
    }
}

TEST(MadeTemporalBone, has_all_its_parts) {
    const BoneData& bone = made_64();
    ASSERT_EQ(bone.structure.size(), 9U);
    std::array<std::size_t, 10> count{};
    for (std::size_t i = 0; i < bone.label.size(); ++i) {
        ++count.at(bone.label[i]);
        if (bone.label[i] == static_cast<std::uint8_t>(EarPart::facial_nerve)) {
            EXPECT_LT(bone.density[i], 130) << "the nerve is not bone";
        }
    }
    for (std::size_t i = 1; i < count.size(); ++i) EXPECT_GT(count[i], 0U) << bone.structure[i - 1].name;
}

TEST(MadeTemporalBone, has_a_hard_shell_over_cells) {
    const BoneData& bone = made_64();
    // A line into the mastoid from the side, behind and below the ear canal.
    const double mm = 64.0 / 50.0;
    const auto x = static_cast<std::uint32_t>((25.0 - 6.0) * mm),
               y = static_cast<std::uint32_t>((25.0 - 6.0) * mm);
    std::uint32_t z = 63;
    while (z > 0 && bone.density[bone.bricks.voxel(x, y, z)] < 128) --z;
    EXPECT_NEAR(z / mm - 25.0, 14.0, 1.6) << "height of the surface";
    EXPECT_GT(bone.density[bone.bricks.voxel(x, y, z - 1)], 200);
    std::size_t thin = 0;
    for (std::uint32_t i = 4; i < 14; ++i) thin += bone.density[bone.bricks.voxel(x, y, z - i)] < 130 ? 1 : 0;
    EXPECT_GT(thin, 4U);
}

TEST(MadeTemporalBone, an_impossible_size_is_refused_before_allocation) {
    for (const std::uint32_t voxels : {0U, 15U, 1025U, 4000000000U}) {
        TemporalBone settings;
        settings.voxels = voxels;
        EXPECT_THROW((void)make_temporal_bone(settings), StartupError);
    }
}

TEST(MadeTemporalBone, can_be_cancelled) {
    TemporalBone settings;
    settings.voxels = 64;
    EXPECT_THROW((void)make_temporal_bone(settings, [](double, const char*) { return false; }), Cancelled);
}

TEST(Distances, match_brute_force_at_grid_points_and_within_the_error_bound_between) {
    BoneData b;
    b.bricks.size = {13, 9, 11};
    b.bricks.voxel_m = 0.3e-3;
    b.bricks.origin_m = Vec3(0.1, 0.2, -0.3);
    b.label.resize(b.bricks.bytes());
    for (std::uint32_t z = 3; z < 8; ++z)
        for (std::uint32_t y = 2; y < 6; ++y)
            for (std::uint32_t x = 3; x < 9; ++x)
                if ((x + y) % 7 != 0) b.label[b.bricks.voxel(x, y, z)] = 2;
    b.label[b.bricks.voxel(12, 8, 10)] = 2;
    b.label[b.bricks.voxel(0, 0, 0)] = 1;
    const BuiltDistances built = build_distances(b.bricks, b.label, 2);
    const DistanceField f = built.view();
    EXPECT_EQ(f.spacing_m, 0.6e-3);
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < f.size[2]; ++z)
        for (std::uint32_t y = 0; y < f.size[1]; ++y)
            for (std::uint32_t x = 0; x < f.size[0]; ++x, ++i)
                ASSERT_NEAR(built.quanta[i] * f.quantum_m,
                            b.bricks.voxel_m * slow_distance(b, 2, 2.0 * Vec3(x, y, z)), 0.51 * f.quantum_m)
                    << x << ' ' << y << ' ' << z;
    double worst = 0.0;
    for (double x = 0.0; x < 12.0; x += 1.7)
        for (double y = 0.0; y < 8.0; y += 1.3)
            for (double z = 0.0; z < 10.0; z += 1.9)
                worst = std::max(worst, std::abs(f.distance_m(b.bricks.to_model(Vec3(x, y, z))) -
                                                 b.bricks.voxel_m * slow_distance(b, 2, Vec3(x, y, z))));
    EXPECT_LE(worst, f.error_m);
    EXPECT_TRUE(build_distances(b.bricks, b.label, 3).quanta.empty()) << "no voxel has that label";
    EXPECT_THROW((void)build_distances(b.bricks, b.label, 2, [](double, const char*) { return false; }),
                 Cancelled);
}

TEST(BakedBone, has_every_section_and_starts_the_hand_in_front_of_the_bone) {
    BoneInput input;
    input.title = "test";
    input.bone = made_64();
    const BoneBricks bricks = input.bone.bricks;
    const std::vector<std::uint8_t> density = input.bone.density;
    SceneWriter out;
    const BakedBone baked = bake_bone(std::move(input), out);
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "bone");
    const SceneMeta meta = read_meta(file);
    EXPECT_EQ(meta.kind, SceneKind::drilling);
    EXPECT_EQ(meta.world_per_model, 1.0);
    const BoneVolumeView bone = read_bone_volume(file);
    EXPECT_TRUE(std::equal(bone.density.begin(), bone.density.end(), density.begin(), density.end()));
    const BoneLabelsView labels = read_bone_labels(file, bone.bricks);
    const std::vector<DistanceField> fields = read_distance_fields(file, labels.structure.size());
    EXPECT_EQ(fields.size(), 8U) << "the malleus is not critical";
    EXPECT_EQ(baked.distance_fields, 8U);
    std::uint32_t front = 0;
    std::uint64_t sum = 0;
    for (std::uint32_t z = 0; z < 64; ++z)
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x)
                if (const std::uint8_t d = bone.at(x, y, z); d > 0) {
                    front = z;
                    sum += d;
                }
    const double front_m = bricks.to_model(Vec3(0, 0, front)).z();
    EXPECT_LE(meta.centre_model_m[2], front_m + 0.01 + 1e-9);
    EXPECT_GT(meta.centre_model_m[2], front_m - 0.01);
    EXPECT_NEAR(baked.bone_m3, static_cast<double>(sum) / 255.0 * 1e-9, 1e-15);
    for (const DistanceField& f : fields)  // the resting hand is outside all of them
        EXPECT_GT(f.distance_m(meta.to_model(Vec3::Zero())), 0.005);
    BoneInput empty;
    empty.bone.bricks.size = {8, 8, 8};
    empty.bone.bricks.voxel_m = 1e-3;
    empty.bone.density.resize(512);
    EXPECT_NE(sample::error_of([&] { (void)bake_bone(std::move(empty), out); }).find("no voxel"),
              std::string::npos);
}

// A relief of 0.5 mm voxels: height in voxels per column, one voxel thick, density 200.
struct Relief {
    BoneBricks bricks{.size = {80, 80, 64}, .voxel_m = 5e-4};
    std::vector<std::uint8_t> row = std::vector<std::uint8_t>(80);
    BoneHeights heights{bricks};
    template <class F>
    explicit Relief(F height, std::uint8_t density = 200) {
        for (std::uint32_t z = 0; z < 64; ++z)
            for (std::uint32_t y = 0; y < 80; ++y) {
                for (std::uint32_t x = 0; x < 80; ++x)
                    row[x] = height(x, y) == static_cast<int>(z) ? density : std::uint8_t{0};
                heights.add_row(y, z, row);
            }
    }
    [[nodiscard]] Vec3 found() const {  // in voxels
        return bricks.to_voxels(heights.place(bricks.to_model(Vec3(40, 40, 0))).surface_m);
    }
};

double off_middle(const Vec3& at) { return std::hypot(at.x() - 40.0, at.y() - 40.0); }

TEST(BoneHeights, bone_in_the_middle_is_chosen) {
    const Relief plate([](std::uint32_t, std::uint32_t) { return 30; });
    EXPECT_LT(off_middle(plate.found()), 3.0);
    EXPECT_NEAR(plate.found().z(), 30.0, 1e-6);
}

TEST(BoneHeights, holes_edges_and_splinters_are_avoided) {
    const auto squared = [](std::uint32_t x, std::uint32_t y) {
        return (static_cast<int>(x) - 40) * (static_cast<int>(x) - 40) +
               (static_cast<int>(y) - 40) * (static_cast<int>(y) - 40);
    };
    // A hole of 7.5 mm with a protruding pin at its centre.
    const Relief ring([&](std::uint32_t x, std::uint32_t y) {
        return squared(x, y) < 2 ? 60 : squared(x, y) < 15 * 15 ? -1 : 30;
    });
    EXPECT_GT(off_middle(ring.found()), 15.0);
    EXPECT_LT(off_middle(ring.found()), 24.0) << "the nearest valid position";
    EXPECT_NEAR(ring.found().z(), 30.0, 1e-6);
    const double front_m = ring.heights.place(ring.bricks.to_model(Vec3(40, 40, 0))).front_m;
    EXPECT_NEAR(ring.bricks.to_voxels(Vec3(0, 0, front_m)).z(), 60.0, 1e-6)
        << "the hand rests in front of the pin";
}

TEST(BoneHeights, on_a_ridge_the_top_is_chosen_and_not_the_flank) {
    const Relief finger([](std::uint32_t x, std::uint32_t) {
        const double off = static_cast<double>(x) - 60.0;  // 8 mm wide
        return std::abs(off) < 8.0 ? static_cast<int>(20.0 + std::sqrt(64.0 - off * off)) : -1;
    });
    EXPECT_NEAR(finger.found().x(), 60.0, 2.5);
}

TEST(BoneHeights, height_is_weighed_against_the_distance_from_the_middle) {
    const Relief step([](std::uint32_t x, std::uint32_t) { return x < 36 ? 60 : 4; });
    EXPECT_LT(step.found().x(), 36.0);
    EXPECT_NEAR(step.found().z(), 60.0, 1e-6);
}

TEST(BoneHeights, without_a_valid_position_the_outermost_voxel_is_chosen) {
    const Relief pins([](std::uint32_t x, std::uint32_t y) {
        return x == 10 && y == 70 ? 50 : x % 8 == 0 && y % 8 == 0 ? 20 : -1;
    });
    EXPECT_EQ(pins.found(), Vec3(10, 70, 50));
    const Relief soft([](std::uint32_t x, std::uint32_t) { return x > 60 ? 12 : -1; }, 20);
    EXPECT_GT(soft.found().x(), 60.0) << "soft bone if there is no other";
}

}  // namespace
}  // namespace tact::prep_volume_test
