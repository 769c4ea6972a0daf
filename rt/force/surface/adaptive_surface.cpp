#include "rt/force/surface/adaptive_surface.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"

namespace tact {
namespace {

constexpr float kTurned = 0.02F;        // smaller changes of the fidelity are ignored
constexpr double kStepsLookS = 3.4e-3;  // times the speed: search radius of a 1 ms step (contact.cpp)
constexpr float kLearns = 0.1F;         // filter weight of each update that builds
constexpr double kKeepsFrom = 0.2;      // fraction of the radius: with less margin, a newer surface is used

RefinementSettings refine_settings(const AdaptiveSettings& s) {
    RefinementSettings r;
    r.filter = FilterForm{}.filter(static_cast<float>(s.most_m));
    r.look_ahead_s = s.look_ahead_s;
    r.splits_max = r.merges_max = 8000;
    return r;
}

double area_m2(const SurfaceMesh& mesh) {
    double area = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
        const auto c = mesh.corners(t);
        const Vec3 a = mesh.position_m(c[0]);
        area += 0.5 * (mesh.position_m(c[1]) - a).cross(mesh.position_m(c[2]) - a).norm();
    }
    return area;
}

}  // namespace

AdaptiveSurface::AdaptiveSurface(const SurfaceMesh& full, const VertexForest& forest,
                                 const AdaptiveSettings& settings)
    : full_(full),
      forest_(forest),
      settings_(settings),
      density_(static_cast<double>(full.triangles()) / std::max(area_m2(full), 1e-30)),
      refinement_(forest_, refine_settings(settings)),
      surface_(NearSurface(settings.near_nodes_max)) {}

double AdaptiveSurface::radius_m(float fidelity) const noexcept {
    const double level = fidelity >= 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    return settings_.least_m + level * (settings_.most_m - settings_.least_m);
}

double AdaptiveSurface::predicted_triangles(float fidelity) const noexcept {
    const double side = 2.0 * radius_m(fidelity);
    return std::min(density_ * side * side, static_cast<double>(full_.triangles()));
}

void AdaptiveSurface::set_filter(float fidelity, const FilterForm& form) noexcept {
    if (std::abs(fidelity - fidelity_) < kTurned && form == form_) return;
    fidelity_ = fidelity;
    form_ = form;
    refinement_.set_filter(form.filter(static_cast<float>(radius_m(fidelity))));
}

// True if the last near surface still suffices: it contains the search radius of a step from here to half of the
// look-ahead path.
bool AdaptiveSurface::still_holds(const Vec3& tool_m, const Vec3& velocity_m_s) const noexcept {
    const double need_m = settings_.least_m + kStepsLookS * velocity_m_s.norm();
    const Vec3 half_way_m = 0.5 * settings_.look_ahead_s * velocity_m_s;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const double here = tool_m[axis], there = here + half_way_m[axis];
        if (std::min(here, there) - need_m < static_cast<double>(built_low_m_[i]) ||
            std::max(here, there) + need_m > static_cast<double>(built_high_m_[i]))
            return false;
    }
    return built_ > 0;
}

RefineStep AdaptiveSurface::slow_update(const Vec3& tool_m, const Vec3& velocity_m_s, float fidelity,
                                        const FilterForm& form) noexcept {
    const Instant begin = Monotonic::now();
    set_filter(fidelity, form);
    const RefineStep done = refinement_.step(tool_m, velocity_m_s);
    if (!done.full_detail || still_holds(tool_m, velocity_m_s)) return done;
    std::array<float, 3> low_m{}, high_m{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float reach_m = done.path.half_m[i] + static_cast<float>(radius_m(fidelity_));
        low_m[i] = done.path.centre_m[i] - reach_m;
        high_m[i] = done.path.centre_m[i] + reach_m;
    }
    if (!surface_.back().build(full_, low_m, high_m, built_ + 1)) return done;
    surface_.publish();
    ++built_;
    built_low_m_ = low_m;
    built_high_m_ = high_m;
    const auto took =
        static_cast<float>(to_s(Monotonic::now() - begin) / std::max(predicted_triangles(fidelity), 1.0));
    const float before = s_per_triangle_.load(std::memory_order_relaxed);
    s_per_triangle_.store(before > 0.0F ? before + kLearns * (took - before) : took,
                          std::memory_order_relaxed);
    return done;
}

bool AdaptiveSurface::around(const Vec3& centre_m, double radius_m) noexcept {
    return surface_.same().holds(centre_m, (1.0 + kKeepsFrom) * radius_m) ||
           surface_.newest().holds(centre_m, radius_m);
}

}  // namespace tact
