#include "tests/bench/touch_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ipc/base/random.hpp"

namespace tact::launch {
namespace {

constexpr double kInS = 0.25, kTapsHz = 3.0;
constexpr double kTouchS = 2.0, kTurnRad = 0.03;  // wander(): time between lifts, largest turn per step

// Radius of the surface in a direction. Marches inwards from from_m in steps of 0.9 times the clearance.
double radius_of_surface(const SurfaceMesh& surface, const Vec3& direction, double from_m) {
    double r = from_m;
    for (int i = 0; i < 400 && r > 0.0; ++i) {
        const double free_m = surface.nearest(r * direction, 1.0).distance_m;
        if (free_m < 1e-6) break;
        r -= 0.9 * free_m;
    }
    return r;
}

Vec3 on_sphere(double around, double up) {
    return {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
}

}  // namespace

std::vector<Vec3> touch_path_m(const SurfaceMesh& surface, TouchPath kind, double pace, std::size_t samples) {
    std::vector<Vec3> path;
    path.reserve(samples);
    const double outside_m = 1.01 * std::max(surface.low_m().norm(), surface.high_m().norm());
    for (std::size_t i = 0; i < samples; ++i) {
        const double real_s = kTouchStepS * static_cast<double>(i), t = pace * real_s;
        Vec3 direction;
        double depth_m = 1.5e-3;
        if (kind == TouchPath::slide) {
            direction = on_sphere(1.1 * t + 0.3 * std::sin(0.7 * t),
                                  0.9 * std::sin(0.61 * t) + 0.2 * std::sin(3.1 * t));
            depth_m += 5e-4 * std::sin(8.2 * t);
        } else if (kind == TouchPath::orbit) {
            direction = on_sphere(1.2 * t, 0.4);
        } else {
            direction = on_sphere(0.1 * t, 0.2);
            depth_m = -0.5e-3 - 2.5e-3 * std::cos(2.0 * std::numbers::pi * kTapsHz * t);
        }
        if (kind != TouchPath::tap) {
            const double in = std::min(1.0, real_s / kInS);
            depth_m = depth_m * in - 3e-3 * (1.0 - in);
        }
        path.push_back((radius_of_surface(surface, direction, outside_m) - depth_m) * direction);
    }
    return path;
}

// The foot point of the hand moves along the surface. The hand lies below it, along the normal averaged over the last
// steps, so that the path has no jumps at edges.
std::vector<WanderPlace> wander(const SurfaceMesh& surface, const Wander& settings, std::size_t samples) {
    SeededRandom random(settings.seed);
    const auto any =
        static_cast<std::uint32_t>(random.uniform() * static_cast<double>(surface.triangles() - 1));
    SurfacePoint foot = surface.nearest(surface.position_m(surface.corners(any)[0]), 1e9);
    const double step_m = kTouchStepS * settings.speed_m_s;
    Vec3 along = random.direction(), normal = surface.normal_at(foot);
    std::vector<WanderPlace> path;
    path.reserve(samples);
    for (std::size_t i = 0; i < samples; ++i) {
        const double t = kTouchStepS * static_cast<double>(i);
        along = Eigen::AngleAxisd(kTurnRad * (2.0 * random.uniform() - 1.0), normal) * along;
        along = (along - along.dot(normal) * normal).normalized();
        const Vec3 before_m = foot.point_m;
        foot = surface.nearest(foot.point_m + step_m * along, 1e9, foot.triangle);
        // At the border of an open surface or in a corner: turn round.
        if ((foot.point_m - before_m).norm() < 0.3 * step_m) along = -along + 0.5 * normal.cross(along);
        Vec3 wanted = surface.normal_at(foot);
        if (wanted.dot(normal) < 0.0) wanted = -wanted;  // the other side of a sheet
        normal = (normal + step_m / settings.even_m * wanted).normalized();
        const double since_lift_s = std::fmod(t, kTouchS);
        const double in = std::min(1.0, std::min(since_lift_s, kTouchS - since_lift_s) / kInS);
        path.push_back(
            {foot.point_m - (settings.depth_m * in - 2.0 * settings.depth_m * (1.0 - in)) * normal, normal});
    }
    return path;
}

std::vector<Vec3> wander_m(const SurfaceMesh& surface, const Wander& settings, std::size_t samples) {
    std::vector<Vec3> path;
    for (const WanderPlace& place : wander(surface, settings, samples)) path.push_back(place.point_m);
    return path;
}

}  // namespace tact::launch
