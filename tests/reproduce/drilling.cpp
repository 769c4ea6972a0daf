#include "tests/reproduce/drilling.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "deploy/tact/files.hpp"
#include "ipc/base/clock.hpp"
#include "rt/force/drilling/ball_moments.hpp"
#include "rt/force/drilling/burr_forces.hpp"
#include "tests/reproduce/draw.hpp"
#include "tests/reproduce/drilling_pictures.hpp"
#include "tests/reproduce/summary.hpp"
#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

constexpr double kVoxelMm = 0.3;
constexpr double kForceMinN = 0.05;  // smaller forces are excluded from the error

// Solid below half of its height, and wide enough that the burr does not reach its sides.
struct FlatBone {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    double surface = 0.0;  // voxels

    explicit FlatBone(double radius_mm) {
        const auto half = static_cast<std::uint32_t>(std::ceil(radius_mm / kVoxelMm)) + 8;
        bricks = {.size = {2 * half, 2 * half, 2 * half}, .voxel_m = 1e-3 * kVoxelMm};
        density.assign(bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < half; ++z)
            for (std::uint32_t y = 0; y < 2 * half; ++y)
                for (std::uint32_t x = 0; x < 2 * half; ++x) density[bricks.voxel(x, y, z)] = 255;
        surface = half - 0.5;
    }
};

double elastic_of(double radius_mm, const BallMoments& m) {
    const double voxel_m = 1e-3 * kVoxelMm, voxel3 = voxel_m * voxel_m * voxel_m / 255.0;
    return burr_force({}, 1e-3 * radius_mm, m.m0 * voxel3, m.m1 * (voxel3 * voxel_m), Vec3::Zero(),
                      Vec3::Zero())
        .wrench.force_n.norm();
}

template <class F>
double least_us(int repeats, double& force_n, const F& force) {
    double least = 1e300;
    for (int i = 0; i < repeats; ++i) {
        const Instant begin = Monotonic::now();
        force_n = force();
        least = std::min(least, to_us(Monotonic::now() - begin));
    }
    return least;
}

std::string method_name(std::size_t method) {
    return method < kDrillBlocks.size() ? text("l = %.1f R", kDrillBlocks[method])
                                        : std::string("voxel by voxel");
}

double error_at(const DrillingRow& r, std::size_t method) {
    return r.true_n > kForceMinN ? 100.0 * (r.force_n[method] / r.true_n - 1.0) : std::nan("");
}

struct Spread {
    double mean = 0.0, most = 0.0;
};
Spread error_of(const std::vector<DrillingRow>& rows, std::size_t method) {
    Spread s;
    int count = 0;
    for (const DrillingRow& r : rows) {
        const double off = std::abs(error_at(r, method));
        if (std::isnan(off)) continue;
        s.mean += off;
        s.most = std::max(s.most, off);
        ++count;
    }
    s.mean /= std::max(count, 1);
    return s;
}

std::string csv_of(const std::vector<DrillingRow>& rows) {
    std::string csv = "radius_mm,penetration_mm,true_n";
    for (const char* const what : {"force_n", "us"})
        for (std::size_t method = 0; method < kDrillWays; ++method)
            csv += "," + std::string(what) +
                   (method < kDrillBlocks.size() ? text("_%.1fR", kDrillBlocks[method])
                                                 : std::string("_voxels"));
    csv += "\n";
    for (const DrillingRow& r : rows) {
        csv += text("%.3f,%.5f,%.6f", r.radius_mm, r.penetration_mm, r.true_n);
        for (const double f : r.force_n) csv += text(",%.6f", f);
        for (const double us : r.us) csv += text(",%.3f", us);
        csv += "\n";
    }
    return csv;
}

std::vector<SummaryRow> summary_of(const std::vector<DrillingRow>& rows,
                                   const std::vector<DrillingRow>& growth) {
    std::vector<SummaryRow> table;
    for (std::size_t method = 0; method < kDrillBlocks.size(); ++method) {
        const Spread s = error_of(rows, method);
        table.push_back(
            {.figure = "2b",
             .quantity = "error of the force, " + method_name(method),
             .published = "a few percent or below",
             .measured = text("%.2f %% on average, %.2f %% at most", s.mean, s.most),
             .differs = "partly covered blocks are cut by planes; the paper replaces them by balls"});
    }
    for (const DrillingRow& r : growth) {
        if (r.radius_mm != 1.0 && r.radius_mm != 6.0 && r.radius_mm != 20.0) continue;
        table.push_back({.figure = "3, 4",
                         .quantity = text("time of a force, R = %.0f mm, 0.3 R", r.radius_mm),
                         .published = r.radius_mm > 6.0 ? "not tried" : "below 1 ms",
                         .measured = text("%.1f us; voxel by voxel %.0f us", r.us[1], r.us[kDrillWays - 1])});
    }
    return table;
}

}  // namespace

std::vector<DrillingRow> drilling_rows(double radius_mm, int depths, int repeats, bool half_in_alone) {
    FlatBone bone(radius_mm);
    const MomentOctree octree(bone.bricks, bone.density);
    const double radius = radius_mm / kVoxelMm, middle = 0.5 * bone.bricks.size[0];
    std::vector<DrillingRow> rows;
    for (int i = 1; i <= depths; ++i) {
        DrillingRow row{.radius_mm = radius_mm};
        row.penetration_mm = half_in_alone ? 0.5 * radius_mm : radius_mm * i / depths;
        // Off the symmetry planes of the grid; moves sideways with depth, like a hand.
        const Vec3 at(middle + 0.13 + 0.9 * i / depths, middle - 0.27 + 0.4 * i / depths,
                      bone.surface + radius - row.penetration_mm / kVoxelMm);
        row.true_n = elastic_of(radius_mm, ball_moments_exact(octree, at, radius));
        for (std::size_t method = 0; method < kDrillBlocks.size(); ++method)
            row.us[method] = least_us(repeats, row.force_n[method], [&] {
                return elastic_of(radius_mm, ball_moments(octree, best_brick_kernels(), at, radius,
                                                          kDrillBlocks[method] * radius));
            });
        row.us.back() = least_us(std::max(repeats / 10, 1), row.force_n.back(), [&] {
            return elastic_of(radius_mm, ball_moments_exact(octree, at, radius, 2));
        });
        rows.push_back(row);
    }
    return rows;
}

int reproduce_drilling(const DrillingExperiment& e) {
    // Checks now that the folder is writable, not after some seconds.
    write_whole(e.out / ".writable", "");
    std::filesystem::remove(e.out / ".writable");
    const int depths = e.quick ? 12 : 150, repeats = e.quick ? 3 : 30;
    std::vector<DrillingRow> rows, growth;
    for (const double radius_mm : {1.0, 3.0, 5.0}) {
        const auto more = drilling_rows(radius_mm, depths, repeats, false);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    for (const double radius_mm : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 14.0, 20.0}) {
        if (e.quick && radius_mm > 6.0) break;
        const auto more = drilling_rows(radius_mm, 1, repeats, true);
        growth.insert(growth.end(), more.begin(), more.end());
    }
    write_whole(e.out / "forces.csv", csv_of(rows));
    write_whole(e.out / "growth.csv", csv_of(growth));
    const std::vector<SummaryRow> table = summary_of(rows, growth);
    write_whole(e.out / "drilling.json", nlohmann::json{{"summary", json_of(table)}}.dump(2) + "\n");
    draw_figures(e.out);
    const int exit_code = e.pictures ? drilling_pictures(e.out, e.quick) : 0;
    std::printf("\n%s\nwrote %s and CSV and PNG files in the same folder\n", table_of(table).c_str(),
                (e.out / "drilling.json").c_str());
    return exit_code;
}

}  // namespace tact::launch
