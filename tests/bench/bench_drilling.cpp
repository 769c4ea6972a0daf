#include "tests/bench/bench_drilling.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ipc/base/error.hpp"
#include "rt/force/drilling/ball_moments.hpp"
#include "rt/force/drilling/burr_forces.hpp"
#include "tests/bench/drill_run.hpp"
#include "tests/bench/positions.hpp"
#include "tests/bench/put_percentiles.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr std::size_t kDrillSteps = 4000;
constexpr int kDrillPasses = 3;  // also part of the key names

struct DrillCase {
    const char* key;
    double radius_m, voxel_m;
    std::array<std::uint32_t, 3> voxels;
    bool finest = false;  // false: the default level
    BurrShape shape = BurrShape::sphere;
};
constexpr DrillCase kDrillCases[] = {
    {"r1_h0.3", 1e-3, 3e-4, {256, 128, 128}},
    {"r3_h0.3", 3e-3, 3e-4, {256, 128, 128}},
    {"r5_h0.3", 5e-3, 3e-4, {256, 128, 128}},
    {"r20_h0.3", 20e-3, 3e-4, {256, 256, 256}},
    {"r3_h0.1", 3e-3, 1e-4, {512, 512, 512}},
    {"r3_h0.3_finest", 3e-3, 3e-4, {256, 128, 128}, true},
    {"r20_h0.3_finest", 20e-3, 3e-4, {256, 256, 256}, true},
    {"r3_h0.1_finest", 3e-3, 1e-4, {512, 512, 512}, true},
    {"r3_h0.3_cylinder", 3e-3, 3e-4, {256, 128, 128}, false, BurrShape::cylinder},
    {"r3_h0.3_cone", 3e-3, 3e-4, {256, 128, 128}, false, BurrShape::cone},
    {"r3_h0.3_cylinder_finest", 3e-3, 3e-4, {256, 128, 128}, true, BurrShape::cylinder},
    {"r3_h0.3_cone_finest", 3e-3, 3e-4, {256, 128, 128}, true, BurrShape::cone}};

struct ForceError {
    double sum = 0.0, most = 0.0;
    int count = 0;
};

double elastic_n(const BoneBricks& bricks, double radius_m, const BallMoments& m) {
    const double voxel3 = std::pow(bricks.voxel_m, 3) / 255.0;
    return burr_force({}, radius_m, m.m0 * voxel3, m.m1 * (voxel3 * bricks.voxel_m), Vec3::Zero(),
                      Vec3::Zero())
        .wrench.force_n.norm();
}

// Adds the force errors at positions along a stroke, in bone that this stroke has already drilled.
void add_force_errors(BoneSample& bone, const std::vector<Vec3>& path_m, double radius_m, ForceError& error) {
    std::vector<std::uint32_t> revision(bone.bricks.brick_count());
    const DrillBone drilled(bone.bricks, bone.density, revision);
    const double radius = radius_m / bone.bricks.voxel_m;
    for (std::size_t i = path_m.size() / 2; i < path_m.size(); i += 23) {
        // Slightly deeper than the drilled hole, to ensure contact.
        const Vec3 at =
            bone.bricks.to_voxels(path_m[i] - Vec3(0.0, 0.0, 0.03 * radius_m * static_cast<double>(i % 7)));
        const double exact = elastic_n(bone.bricks, radius_m, ball_moments_exact(drilled.octree, at, radius));
        if (!(exact > 0.05)) continue;
        const double coarse = elastic_n(bone.bricks, radius_m,
                                        ball_moments(drilled.octree, best_brick_kernels(), at, radius,
                                                     DrillModel::kBlockDefault * radius));
        const double off = std::abs(coarse - exact) / exact;
        error.sum += off;
        error.most = std::max(error.most, off);
        ++error.count;
    }
}

// Integrates equation 12 voxel by voxel in small time steps, for a straight stroke through solid bone.
double eroded_levels(const BoneSample& bone, const Vec3& from_m, const Vec3& to_m, double seconds,
                     double radius_m, const DrillSettings& law) {
    constexpr int kParts = 600;
    const double a = law.rate_per_s, dt = seconds / kParts;
    double sum = 0.0;
    for (std::uint32_t z = 0; z < bone.bricks.size[2]; ++z)
        for (std::uint32_t y = 0; y < bone.bricks.size[1]; ++y)
            for (std::uint32_t x = 0; x < bone.bricks.size[0]; ++x) {
                const double initial = bone.density[bone.bricks.voxel(x, y, z)];
                const Vec3 at = bone.bricks.to_model(Vec3(x, y, z));
                const Vec3 stroke = to_m - from_m;
                const double along = std::clamp((at - from_m).dot(stroke) / stroke.squaredNorm(), 0.0, 1.0);
                if (!(initial > 0.0) || (at - from_m - along * stroke).squaredNorm() >= radius_m * radius_m)
                    continue;
                double left = initial;
                for (int k = 0; k < kParts; ++k) {
                    const double r2 =
                        (at - from_m - (k + 0.5) / kParts * stroke).squaredNorm() / (radius_m * radius_m);
                    if (r2 >= 1.0) continue;
                    const double rate = a * (law.soft + (1.0 - law.soft) * left / 255.0);
                    left *= std::exp(-rate * (1.0 - r2) * dt);
                }
                sum += initial - left;
            }
    return sum;
}

void add_removed_volume_errors(json& all) {
    double most = 0.0;
    const double radius_m = 2e-3, length_m = 10e-3;
    for (const double speed_m_s : {0.005, 0.02, 0.08, 0.2}) {
        BoneSample bone;
        bone.bricks = {.size = {64, 32, 32}, .voxel_m = 3e-4, .origin_m = Vec3::Constant(1.5e-4)};
        bone.density.assign(bone.bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < 16; ++z)
            for (std::uint32_t y = 0; y < 32; ++y)
                for (std::uint32_t x = 0; x < 64; ++x) bone.density[bone.bricks.voxel(x, y, z)] = 255;
        const Vec3 from(4.6e-3, 4.8e-3, 5.2e-3), to = from + Vec3(length_m, 0.0, 0.0);
        const double seconds = length_m / speed_m_s;
        const double truth = eroded_levels(bone, from, to, seconds, radius_m, {});
        for (const double rate_hz : {500.0, 1000.0, 2000.0, 4000.0}) {
            BoneSample fresh = bone;
            const auto steps = static_cast<std::size_t>(std::lround(seconds * rate_hz));
            std::vector<Vec3> path(steps + 1);
            for (std::size_t i = 0; i <= steps; ++i)
                path[i] = from + static_cast<double>(i) / static_cast<double>(steps) * (to - from);
            std::uint64_t removed = 0;
            for (const DrillStep& s :
                 drill_along(fresh, path, {.radius_m = radius_m, .step_s = 1.0 / rate_hz}))
                removed += s.removed_levels;
            const double error = static_cast<double>(removed) / truth - 1.0;
            char key[64];
            std::snprintf(key, sizeof key, "removed_volume_error_%.0f_hz_%.0f_mm_s", rate_hz,
                          1e3 * speed_m_s);
            all[key] = error;
            most = std::max(most, std::abs(error));
        }
    }
    all["removed_volume_error_max"] = most;
}

}  // namespace

json bench_drilling() {
    json all;
    ForceError error;
    for (const DrillCase& c : kDrillCases) {
        BoneSample bone = bone_block(c.voxels, c.voxel_m);
        const std::vector<Vec3> path = drill_stroke_m(bone, c.radius_m, kDrillSteps);
        const auto steps = drill_along(bone, path,
                                       {.fidelity = c.finest ? 1.0F : default_fidelity(),
                                        .radius_m = c.radius_m,
                                        .shape = c.shape,
                                        .passes = kDrillPasses,
                                        .paced = true});
        std::uint64_t removed = 0;
        for (const DrillStep& s : steps) removed += s.removed_levels;
        const std::string key = c.key;
        put_percentiles(all, "cycle_us", times_us(steps), "_" + key);
        put_percentiles(all, "cycle_us_best_of_3", best_times_us(steps), "_" + key);
        all["removed_mm3_" + key] = static_cast<double>(removed) / 255.0 * std::pow(1e3 * c.voxel_m, 3);
        if (c.radius_m < 10e-3 && c.shape == BurrShape::sphere && !c.finest)
            add_force_errors(bone, path, c.radius_m, error);
    }
    all["force_error_mean"] = error.count > 0 ? error.sum / error.count : 0.0;
    all["force_error_max"] = error.most;
    all["force_error_places"] = error.count;
    add_removed_volume_errors(all);
    return all;
}

std::string drilling_work_csv(const DrillingWork& work) {
    if (work.size.size() != 3)
        throw StartupError("drill into " + work.volume.string(), "--size needs three numbers",
                           "write --size X Y Z");
    BoneSample bone =
        bone_of_raw_file(work.volume, {work.size[0], work.size[1], work.size[2]}, 1e-3 * work.voxel_mm);
    const std::vector<Vec3> path = read_positions(work.trajectory, 1e-3);
    const auto steps = drill_along(
        bone, path,
        {.radius_m = 1e-3 * work.radius_mm, .passes = kDrillPasses, .paced = true, .count_voxels = true});
    std::string text =
        "t_s,force_x_n,force_y_n,force_z_n,us,removed_voxels,removed_mass_voxels,best_of_3_us\n";
    char row[220];
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const DrillStep& s = steps[i];
        std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f,%.6f,%.3f,%llu,%.4f,%.3f\n",
                      kDrillStepS * static_cast<double>(i), s.force_n.x(), s.force_n.y(), s.force_n.z(), s.us,
                      static_cast<unsigned long long>(s.removed_voxels),
                      static_cast<double>(s.removed_levels) / 255.0, s.best_us);
        text += row;
    }
    return text;
}

}  // namespace tact::launch
