#include "rt/force/drilling/drill_load.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {
namespace {

constexpr double kErrorLeast = 0.012, kErrorPerBlock = 0.2, kErrorRough = 0.6;
constexpr double kErrorPerVoxel2 = 1.0, kErrorPerVoxel4 = 2.8, kErrorThinCap = 0.08;
constexpr double kSurfacePerEdge2 = 1.5;  // cubes that a surface meets, on average of its directions

// Cubes of an edge that a ball's surface in bone meets.
struct SurfaceInBone {
    double area, rim;
    explicit SurfaceInBone(double radius, double x)
        : area(2.0 * std::numbers::pi * radius * radius * x),
          rim(2.0 * std::numbers::pi * radius * std::sqrt(std::max(x * (2.0 - x), 0.0))) {}
    [[nodiscard]] double met(double edge) const {
        return 1.0 + kSurfacePerEdge2 * (area / (edge * edge) + rim / edge);
    }
};

// Blocks that a walk of the octree visits, up to a common factor.
DrillWork surface_work(const BallLook& look, double block) noexcept {
    const double x = std::clamp(look.depth, 0.01, 2.0), r = look.radius;
    const SurfaceInBone surface(r, x);
    const double l = std::clamp(block * depth_part(x), 1.0, kBlockMost * r);
    // Of the blocks of an edge, those that are larger than asked: asked is l in bone, l / 2 where bone and air meet.
    const auto share = [&](double edge) { return edge > l ? 1.0 : 2.0 * edge > l ? look.mixed : 0.0; };
    DrillWork work;
    const double parts = share(8.0), voxels = share(4.0);
    // Where voxels alone are summed their parts still count, so that no finer level is expected to be cheaper.
    work.blocks = 8.0;
    work.parts = 8.0 * surface.met(8.0) * parts;
    work.summed = surface.met(8.0) * voxels;
    for (int power = 4; std::ldexp(1.0, power) < 2.0 * r; ++power) {
        const double edge = std::ldexp(1.0, power);
        work.blocks += 8.0 * surface.met(edge) * share(edge);
    }
    return work;
}

}  // namespace

DrillWork expected_work(const DrillWork& found, const BallLook& as, double block) noexcept {
    DrillWork work = found;
    work.cut = work.changed = work.walked = 0.0;
    if (!(as.block > 0.0) || !(as.depth > 0.0)) return work;
    const DrillWork then = surface_work(as, as.block), now = surface_work(as, block);
    const double scale = found.blocks / then.blocks;
    work.blocks = scale * now.blocks;
    // Where few were looked at yet, those of the blocks' scale in addition.
    const auto scaled = [scale](double was, double of, double to) {
        return of > 1.0 && was > 0.0 ? was * to / of : std::max(was + scale * (to - of), 0.0);
    };
    work.parts = scaled(found.parts, then.parts, now.parts);
    work.summed = scaled(found.summed, then.summed, now.summed);
    return work;
}

double BlockDetail::asked(double depth) const noexcept {
    return depth < 0.0 ? block : block * std::pow(depth_part(depth), -rough);
}

double shallow_share(double depth) noexcept { return (1.0 - depth_part(depth)) / (1.0 - depth_part(0.0)); }

double block_error_n(const BlockDetail& d, double elastic_n, double shallow_n) noexcept {
    return (kErrorLeast + kErrorPerBlock * d.block * d.block) * elastic_n +
           kErrorRough * d.rough * d.rough * shallow_n;
}

// Deep in bone the moment is small, and its direction less certain. A cap that is thinner than a voxel has an error of its
// own.
double voxel_error_n(double elastic_full_n, double depth, double voxel) noexcept {
    const double v2 = voxel * voxel, deep = 1.0 + 2.0 * std::max(depth - 1.0, 0.0);
    const double share = deep * (kErrorPerVoxel2 * v2 + kErrorPerVoxel4 * v2 * v2);
    return elastic_full_n *
           std::max(share * depth * std::sqrt(depth), kErrorThinCap * voxel * std::sqrt(voxel));
}

double pending_error_n(const BurrLaw& law, double radius_m, double soft, const BurrForce& f, double m0_m3,
                       double m1_m4, double speed_m_s) noexcept {
    const double x = f.depth;
    if (!(x > 0.0) || !(m0_m3 > 0.0)) return 0.0;
    const double r2 = radius_m * radius_m;
    const double elastic_n = law.elastic_pa * r2 * x * std::sqrt(x),
                 impact_n = law.impact_n_s_m3 * r2 * x * speed_m_s;
    const double lost = soft * std::min(x, 1.0);  // of m0, per exposure
    // d log x / d log m0 of eq. 2.
    const double slope = (1.0 - x / 3.0) / std::max(2.0 - x, 0.5);
    // What goes on one side turns the normal, by its lever over the moment.
    const double lever = x < 1.0 ? std::sqrt(x * (2.0 - x)) : 1.0;
    const double turn = lever * std::min(m0_m3 * radius_m / std::max(m1_m4, 1e-30), 4.0);
    return lost * (slope * (1.5 * (1.0 + law.friction_share) * elastic_n + impact_n) + turn * elastic_n);
}

}  // namespace tact
