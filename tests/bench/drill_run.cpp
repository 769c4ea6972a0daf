#include "tests/bench/drill_run.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "ipc/base/error.hpp"
#include "tests/bench/loop_thread.hpp"

namespace tact::launch {
namespace {

constexpr double kSurfaceShare = 0.78;  // fraction of the block's height
constexpr double kShellM = 3e-3;

SceneMeta plain_meta() {
    SceneMeta meta{};
    meta.kind = SceneKind::drilling;
    meta.world_per_model = 1.0;
    return meta;
}

double waves(double x, double y, double z) {
    return std::sin(1.7 * x + 0.4 * z) * std::sin(1.3 * y + 0.9) +
           0.5 * std::sin(2.9 * x - 1.9 * y + 2.3 * z);
}

// Counts the voxels of bone in each brick; recounts only bricks whose revision has changed.
class SolidVoxels {
public:
    SolidVoxels(const BoneSample& bone, const std::vector<std::uint32_t>& revision)
        : bone_(bone), revision_(revision), seen_(revision.size(), ~0U), solid_(revision.size()) {}
    // Voxels lost since the last call.
    std::uint64_t lost() {
        std::uint64_t lost = 0;
        for (std::size_t b = 0; b < seen_.size(); ++b) {
            if (seen_[b] == revision_[b]) continue;
            seen_[b] = revision_[b];
            const auto first = bone_.density.begin() + static_cast<std::ptrdiff_t>(b * BoneBricks::kVoxels);
            const auto now =
                static_cast<std::uint32_t>(BoneBricks::kVoxels - static_cast<std::size_t>(std::count(
                                                                     first, first + BoneBricks::kVoxels, 0)));
            lost += solid_[b] > now ? solid_[b] - now : 0;
            solid_[b] = now;
        }
        return lost;
    }

private:
    const BoneSample& bone_;
    const std::vector<std::uint32_t>& revision_;
    std::vector<std::uint32_t> seen_, solid_;
};

}  // namespace

double block_surface_m(const BoneSample& bone, double x_m, double y_m) {
    const double height = bone.bricks.voxel_m * bone.bricks.size[2];
    return kSurfaceShare * height + 8e-4 * waves(x_m / 1.2e-2, y_m / 1.2e-2, 0.0);
}

BoneSample bone_block(std::array<std::uint32_t, 3> voxels, double voxel_m) {
    BoneSample bone;
    bone.bricks = {.size = voxels, .voxel_m = voxel_m, .origin_m = Vec3::Constant(0.5 * voxel_m)};
    bone.density.assign(bone.bricks.bytes(), 0);
    for (std::uint32_t y = 0; y < voxels[1]; ++y)
        for (std::uint32_t x = 0; x < voxels[0]; ++x) {
            const Vec3 ground = bone.bricks.to_model(Vec3(x, y, 0));
            const double surface = block_surface_m(bone, ground.x(), ground.y());
            for (std::uint32_t z = 0; z < voxels[2]; ++z) {
                const Vec3 at = bone.bricks.to_model(Vec3(x, y, z)) / 2.5e-3;
                const double depth = surface - bone.bricks.to_model(Vec3(x, y, z)).z();
                if (depth < 0.0) break;
                const bool air = depth > kShellM && waves(2.0 * at.x(), 2.0 * at.y(), 2.0 * at.z()) > 0.6;
                const double level = air               ? 0.0
                                     : depth > kShellM ? 170.0 + 20.0 * waves(at.x(), at.y(), at.z())
                                                       : 255.0;
                bone.density[bone.bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(level);
            }
        }
    return bone;
}

BoneSample bone_of_raw_file(const std::filesystem::path& file, std::array<std::uint32_t, 3> voxels,
                            double voxel_m) {
    const std::string attempt = "read the volume " + file.string();
    BoneSample bone;
    bone.bricks = {.size = voxels, .voxel_m = voxel_m, .origin_m = Vec3::Constant(0.5 * voxel_m)};
    const std::uint64_t bytes = std::uint64_t{voxels[0]} * voxels[1] * voxels[2];
    std::error_code none;
    const auto bytes_found = std::filesystem::file_size(file, none);
    if (none || bytes_found != bytes)
        throw StartupError(attempt,
                           none ? none.message()
                                : "the file has " + std::to_string(bytes_found) + " bytes instead of " +
                                      std::to_string(bytes),
                           "use a raw file of one byte per voxel, and set its size with --size X Y Z");
    std::ifstream in(file, std::ios::binary);
    bone.density.assign(bone.bricks.bytes(), 0);
    std::vector<char> row(voxels[0]);
    for (std::uint32_t z = 0; z < voxels[2]; ++z)
        for (std::uint32_t y = 0; y < voxels[1]; ++y) {
            if (!in.read(row.data(), static_cast<std::streamsize>(row.size())))
                throw StartupError(attempt, "the file is shorter than expected", "copy it again");
            for (std::uint32_t x = 0; x < voxels[0]; ++x)
                bone.density[bone.bricks.voxel(x, y, z)] = static_cast<std::uint8_t>(row[x]);
        }
    return bone;
}

std::vector<Vec3> drill_stroke_m(const BoneSample& bone, double radius_m, std::size_t steps) {
    const Vec3 size =
        bone.bricks.voxel_m * Vec3(bone.bricks.size[0], bone.bricks.size[1], bone.bricks.size[2]);
    const double far = std::min(0.018, 0.2 * size.x()), aside = std::min(0.006, 0.1 * size.y());
    std::vector<Vec3> path(steps);
    for (std::size_t i = 0; i < steps; ++i) {
        const double t = kDrillStepS * static_cast<double>(i);
        const double x = 0.5 * size.x() + far * std::sin(std::numbers::pi * t),
                     y = 0.5 * size.y() + aside * std::sin(2.0 * std::numbers::pi * 0.11 * t);
        const double depth = t < 0.5 ? -2e-3 + 4e-3 * t : 3e-4 * (t - 0.5);
        path[i] = Vec3(x, y, block_surface_m(bone, x, y) + radius_m - depth);
    }
    return path;
}

float default_fidelity() {
    return static_cast<float>(std::log(DrillModel::kBlockDefault / DrillModel::kBlockCoarse) /
                              std::log(DrillModel::kBlockFine / DrillModel::kBlockCoarse));
}

std::vector<DrillStep> drill_along(BoneSample& bone, const std::vector<Vec3>& path_m,
                                   const DrillRunSettings& settings) {
    const std::vector<std::uint8_t> undrilled =
        settings.passes > 1 ? bone.density : std::vector<std::uint8_t>{};
    std::vector<DrillStep> steps(path_m.size());
    DrillSettings model_settings;
    model_settings.tool.shape = settings.shape;
    model_settings.tool.radius_m = settings.radius_m;
    model_settings.tool.length_m = settings.length_m;
    model_settings.tool.tip_radius_m = settings.tip_radius_m;
    model_settings.tool.shaft_radius_m = 0.0;
    model_settings.force_n_max = 100.0;
    std::vector<std::uint32_t> revision(bone.bricks.brick_count());
    const auto run_pass = [&](int pass) {
        if (pass > 0) bone.density = undrilled;
        DrillBone drilled(bone.bricks, bone.density, revision);
        DrillModel model(plain_meta(), drilled, model_settings);
        ToolState tool;
        if (!path_m.empty()) tool.T_world_tool.p_m = path_m.front();
        model.reset(tool);
        model.turn_burr({.burr_rad_s = 0.0, .step_s = settings.step_s});
        for (int i = 0; i < ForceFade::ramp_steps(settings.step_s); ++i)
            static_cast<void>(model.step(tool, {.fidelity = settings.fidelity}));
        std::uint64_t removed = model.removed_levels();
        SolidVoxels solid(bone, revision);
        if (settings.count_voxels) static_cast<void>(solid.lost());
        model.turn_burr({.burr_rad_s = settings.burr_rad_s, .step_s = settings.step_s});
        LoopPace pace(settings.paced && pass == 0 ? settings.step_s : 0.0);
        for (std::size_t i = 0; i < path_m.size(); ++i) {
            tool.twist_world.linear_m_s =
                i == 0 ? Vec3(Vec3::Zero()) : Vec3((path_m[i] - path_m[i - 1]) / settings.step_s);
            tool.T_world_tool.p_m = path_m[i];
            pace.wait();
            const Instant begin = Monotonic::now();
            const StepResult result = model.step(tool, {.fidelity = settings.fidelity});
            const double us = to_us(Monotonic::now() - begin);
            DrillStep& step = steps[i];
            if (pass == 0) step.us = us;
            step.best_us = std::min(step.best_us, us);
            step.force_n = result.wrench_world.force_n;
            step.removed_levels = model.removed_levels() - removed;
            removed = model.removed_levels();
            if (settings.count_voxels) step.removed_voxels = solid.lost();
        }
    };
    for (int pass = 0; pass < settings.passes; ++pass) {
        if (settings.paced && pass == 0)
            run_as_loop(kServoPriority, [&] { run_pass(0); });
        else
            run_pass(pass);
    }
    return steps;
}

Percentiles times_us(const std::vector<DrillStep>& steps) {
    std::vector<double> us;
    for (const DrillStep& s : steps) us.push_back(s.us);
    return percentiles(us);
}

Percentiles best_times_us(const std::vector<DrillStep>& steps) {
    std::vector<double> us;
    for (const DrillStep& s : steps) us.push_back(s.best_us);
    return percentiles(us);
}

}  // namespace tact::launch
