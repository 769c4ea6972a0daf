// A mesh in world metres with a list of cells of its own, and a hand that strays over it: for the certificates of surfaces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ipc/base/random.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "tests/reference/surface_reference.hpp"

namespace tact {

inline constexpr double kSurfaceStepS = 1e-3, kDeepestM = 3e-3, kLiftM = 4e-3;
inline constexpr double kHandM = 5e-5;   // change of a step's way from step to step: 50 m/s^2
inline constexpr int kStraySteps = 500;  // between two fresh places

// The triangles of a mesh in world metres, by cubes of equal size.
class Cells {
public:
    Cells(const SurfaceMesh& mesh, const SceneMeta& meta) {
        for (std::uint32_t v = 0; v < mesh.vertices(); ++v)
            all_.vertex.push_back(meta.to_world(mesh.position_m(v)));
        double sum_m = 0.0;
        for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
            const auto corner = mesh.corners(t);
            all_.corner.push_back({corner[0], corner[1], corner[2]});
            sum_m += (all_.vertex[corner[1]] - all_.vertex[corner[0]]).norm();
        }
        size_m_ =
            std::max(2.0 * sum_m / static_cast<double>(std::max<std::size_t>(mesh.triangles(), 1)), 5e-4);
        for (std::uint32_t t = 0; t < all_.corner.size(); ++t)
            each(low_m(t), high_m(t), [&](std::int64_t cell) { in_[cell].push_back(t); });
    }
    [[nodiscard]] const reference::Triangles& all() const { return all_; }
    // Those whose boxes come within reach_m.
    [[nodiscard]] reference::Triangles near(const Vec3& place_m, double reach_m) const {
        std::vector<std::uint32_t> found;
        const Vec3 low = place_m.array() - reach_m, high = place_m.array() + reach_m;
        each(low, high, [&](std::int64_t cell) {
            if (const auto at = in_.find(cell); at != in_.end())
                for (const std::uint32_t t : at->second)
                    if ((low_m(t).array() <= high.array()).all() && (high_m(t).array() >= low.array()).all())
                        found.push_back(t);
        });
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        reference::Triangles some;
        for (const std::uint32_t t : found) {
            const auto n = static_cast<std::uint32_t>(some.vertex.size());
            for (const std::uint32_t c : all_.corner[t]) some.vertex.push_back(all_.vertex[c]);
            some.corner.push_back({n, n + 1, n + 2});
        }
        return some;
    }

    // No triangle within reach_m.
    [[nodiscard]] bool is_clear(const Vec3& place_m, double reach_m) const {
        bool clear = true;
        const auto look = [&](std::int64_t cell) {
            const auto at = clear ? in_.find(cell) : in_.end();
            if (at == in_.end()) return;
            clear = std::all_of(at->second.begin(), at->second.end(), [&](std::uint32_t t) {
                const auto& c = all_.corner[t];
                return reference::nearest(all_.vertex[c[0]], all_.vertex[c[1]], all_.vertex[c[2]], place_m)
                           .distance > reach_m;
            });
        };
        each(place_m.array() - reach_m, place_m.array() + reach_m, look);
        return clear;
    }

private:
    [[nodiscard]] Vec3 low_m(std::uint32_t t) const {
        const auto& c = all_.corner[t];
        return all_.vertex[c[0]].cwiseMin(all_.vertex[c[1]]).cwiseMin(all_.vertex[c[2]]);
    }
    [[nodiscard]] Vec3 high_m(std::uint32_t t) const {
        const auto& c = all_.corner[t];
        return all_.vertex[c[0]].cwiseMax(all_.vertex[c[1]]).cwiseMax(all_.vertex[c[2]]);
    }
    template <class Visit>
    void each(const Vec3& low, const Vec3& high, const Visit& visit) const {
        const auto cell = [&](double m) { return static_cast<std::int64_t>(std::floor(m / size_m_)); };
        for (std::int64_t z = cell(low.z()); z <= cell(high.z()); ++z)
            for (std::int64_t y = cell(low.y()); y <= cell(high.y()); ++y)
                for (std::int64_t x = cell(low.x()); x <= cell(high.x()); ++x)
                    visit((z * 2'097'143 + y) * 2'097'143 + x);
    }

    reference::Triangles all_;
    double size_m_ = 1.0;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> in_;
};

// A hand that strays; it lifts now and then, and never presses deeper than kDeepestM.
class Stray {
public:
    Stray(const Cells& cells, SeededRandom& random) : cells_(cells), mesh_(cells.all()), random_(random) {}

    // Above a place of the surface, where a ball of clear_m is free; the hand then goes to where a ball of radius_m presses.
    Vec3 begin(double radius_m, double clear_m) {
        auto [foot, normal] = place();
        // Above the surface, and clear of all other parts of it.
        clear_ = false;
        for (int tries = 0; tries < 200 && !clear_; ++tries) {
            if (tries > 0) std::tie(foot, normal) = place();
            clear_ = cells_.is_clear(foot + (clear_m + kLiftM) * normal, clear_m + 1e-4);
        }
        moved_.setZero();
        goal_ = foot + (clear_m + kLiftM) * normal;
        to_ = foot + (radius_m - kDeepestM * random_.uniform()) * normal;
        choose_speed();
        return goal_;
    }
    [[nodiscard]] bool clear() const { return clear_; }  // begin() found a place free of triangles
    Vec3 next(const Vec3& proxy_m, double radius_m) {
        if ((to_ - goal_).norm() <= speed_m_) {
            const Vec3 aside = random_.within(0.02);
            const double choice = random_.uniform();
            if (choice < 0.15)
                pause_ = 40;
            else if (choice < 0.3)
                to_ = proxy_m + (proxy_m - goal_).normalized() * kLiftM + 0.1 * aside;
            else
                to_ = proxy_m + aside + 0.5 * radius_m * random_.direction();
            choose_speed();
        }
        if ((goal_ - proxy_m).norm() > kDeepestM) to_ = proxy_m;
        Vec3 wanted = to_ - goal_;
        const double left = wanted.norm();
        // Slow enough to stop at the target.
        wanted *= pause_ > 0 || left == 0.0
                      ? 0.0
                      : std::min({speed_m_ / left, 1.0, std::sqrt(2.0 * kHandM / left)});
        if (pause_ > 0) --pause_;
        const Vec3 change = wanted - moved_;
        moved_ += std::min(kHandM / std::max(change.norm(), 1e-12), 1.0) * change;
        goal_ += moved_;
        return goal_;
    }

private:
    std::pair<Vec3, Vec3> place() {
        for (;;) {
            const auto& c = mesh_.corner[random_.below(mesh_.corner.size())];
            const Vec3 &a = mesh_.vertex[c[0]], &b = mesh_.vertex[c[1]], &d = mesh_.vertex[c[2]];
            const Vec3 normal = (b - a).cross(d - a);
            if (normal.norm() > 0.0) return {(a + b + d) / 3.0, normal.normalized()};
        }
    }
    void choose_speed() { speed_m_ = 0.5 * kSurfaceStepS * std::pow(10.0, -2.0 * random_.uniform()); }

    const Cells& cells_;
    const reference::Triangles& mesh_;
    SeededRandom& random_;
    Vec3 goal_ = Vec3::Zero(), to_ = Vec3::Zero(), moved_ = Vec3::Zero();
    double speed_m_ = 1e-4;  // per step
    int pause_ = 0;
    bool clear_ = false;
};

}  // namespace tact
