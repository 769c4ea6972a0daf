// Which triangles a move of the contact concerns: the collected ones, those in reach, and the side at the start.
#include <algorithm>
#include <bit>
#include <cmath>

#include "rt/force/surface/contact.hpp"

namespace tact {
namespace {

constexpr double kCollectedTooFar = 8.0;
constexpr std::size_t kCollectedSparse = 16;
constexpr double kWidenMost = 256.0;
constexpr std::size_t kCollectedFew = 4096;
constexpr std::uint32_t kSeatVisits = 4096;  // tree nodes, about 100 us

}  // namespace

// False: too many triangles.
bool SurfaceContact::find(double radius_m) noexcept {
    if (settings_.brute) return all_.near(proxy_m_, radius_m, triangle_, collected_);
    std::size_t leaves = 0;
    if (!mesh_.leaves_near(proxy_m_, radius_m, leaf_, leaves)) return false;
    collected_ = 0;
    for (std::size_t l = 0; l < leaves; ++l) {
        const std::uint32_t first = SurfaceNode::leaf_first(leaf_[l]),
                            count = SurfaceNode::leaf_count(leaf_[l]);
        for (std::uint32_t t = first; t < first + count; ++t) triangle_[collected_++] = t;
    }
    return true;
}

// Collects triangles for moves of reach_m, and shortens reach_m if there are too many. False: too many even for the
// shortest move.
bool SurfaceContact::collect(double& reach_m) noexcept {
    const double moved = (proxy_m_ - collected_at_m_).norm();
    const bool too_many = collected_ > kCollectedFew && collected_m_ - moved > kCollectedTooFar * reach_m;
    if (collected_m_ >= 0.0 && moved + reach_m <= collected_m_ && !too_many) return true;
    double wide = kCollectedMoves * reach_m * (whole_ ? widen_ : 1.0);
    for (int attempt = 0; attempt < 12; ++attempt) {
        if (find(settings_.radius_m + wide)) {
            std::fill_n(bound_m_.begin(), collected_, 0.0F);
            collected_at_m_ = proxy_m_;
            collected_m_ = wide;
            way_m_ = 0.0;
            reach_m = std::min(reach_m, wide);
            // Few triangles cost little to query once, and many easy steps need none.
            if (collected_ < kCollectedSparse) widen_ = std::min(2.0 * widen_, kWidenMost);
            if (collected_ > 4 * kCollectedSparse) widen_ = std::max(0.5 * widen_, 1.0);
            return true;
        }
        wide = attempt == 0 ? reach_m : 0.5 * wide;
        widen_ = 1.0;
    }
    collected_m_ = -1.0;
    return false;
}

// Adds the half-spaces of all triangles that a move of reach_m can touch. Shortens reach_m if they are too many, and
// extends it up to most_m if that adds no further batch of queries.
void SurfaceContact::query(double& reach_m, double most_m, std::uint32_t& triangles) noexcept {
    QueryJob job = mesh_.query_job(proxy_m_);
    TriangleQueries seen;
    const auto way = static_cast<float>(way_m_ * (1.0 - kBoundSlack));
    const auto bound = [&](double reach) {
        return static_cast<float>((settings_.radius_m + reach + way_m_) * (1.0 + kBoundSlack));
    };
    if (most_m > reach_m) {
        const float narrow = bound(reach_m), wide = bound(most_m);
        std::size_t some = 0, all = 0;
        for (std::size_t i = 0; i < collected_; ++i) {
            some += bound_m_[i] <= narrow ? 1 : 0;
            all += bound_m_[i] <= wide ? 1 : 0;
        }
        if (all <= 2 * kLooks || all == some) reach_m = most_m;
    }
    for (int attempt = 0; attempt < 8; ++attempt) {
        half_spaces_.clear();
        job.limit = static_cast<float>(settings_.radius_m + reach_m);
        const float in_reach = bound(reach_m);
        std::size_t count = 0;
        for (std::size_t i = 0; i < collected_; ++i) {
            slot_[count] = static_cast<std::uint32_t>(i);
            number_[count] = triangle_[i];
            count += bound_m_[i] <= in_reach ? 1 : 0;
        }
        triangles += static_cast<std::uint32_t>(count);
        bool room = true;
        for (std::size_t first = 0; first < count && room; first += kLooks) {
            const std::size_t lanes = std::min(kLooks, count - first);
            for (std::size_t lane = lanes; lane < kLooks; ++lane) number_[first + lane] = number_[first];
            job.triangle = &number_[first];
            kernel_->query(job, seen);
            for (std::size_t lane = 0; lane < lanes; ++lane)
                bound_m_[slot_[first + lane]] = seen.distance[lane] + way;
            std::uint32_t near = seen.near & ((lanes < kLooks ? 1U << lanes : 0U) - 1U);
            for (; near != 0 && room; near &= near - 1)
                room = half_space(number_[first + static_cast<std::size_t>(std::countr_zero(near))], seen,
                                  static_cast<std::size_t>(std::countr_zero(near)));
        }
        if (room) return;
        reach_m *= 0.5;
    }
    reach_m = 0.0;
}

// False: no room.
bool SurfaceContact::half_space(std::uint32_t triangle, const TriangleQueries& seen,
                                std::size_t lane) noexcept {
    const double radius = settings_.radius_m, margin = settings_.margin_m;
    const bool over = (seen.over >> lane & 1U) != 0;
    // Push out by at most one margin per move: a penetration comes from rounding or from seating.
    const double slack =
        std::max(static_cast<double>(seen.distance[lane]) - (over ? radius : radius - margin), -margin);
    const double height = static_cast<double>(seen.height[lane]) - radius;
    const double sunk = kSunkMargins * margin;
    return half_spaces_.add(triangle, seen, lane, static_cast<float>(slack),
                            static_cast<float>(std::max(height, -sunk)), !over && height >= -sunk);
}

// Of the triangles that share the nearest point, the one that the point is highest above decides the side (the point
// may be behind the other triangle of an edge).
bool SurfaceContact::inside(const Vec3& point_m, const SurfacePoint& nearest) noexcept {
    const double reach = nearest.distance_m * (1.0 + 1e-5);
    std::uint32_t teller = nearest.triangle;
    collected_m_ = -1.0;
    std::size_t leaves = 0;
    if (mesh_.leaves_near(point_m, reach, leaf_, leaves)) {
        double highest = -1.0;
        for (std::size_t l = 0; l < leaves; ++l) {
            const std::uint32_t first = SurfaceNode::leaf_first(leaf_[l]);
            for (std::uint32_t t = first; t < first + SurfaceNode::leaf_count(leaf_[l]); ++t) {
                const SurfacePoint at = mesh_.point_of(t, point_m);
                if (at.distance_m > reach) continue;
                const double height = std::abs(mesh_.facet_normal(t).dot(point_m - at.point_m));
                if (height <= highest) continue;
                highest = height;
                teller = t;
            }
        }
    }
    return mesh_.facet_normal(teller).dot(point_m - mesh_.point_of(teller, point_m).point_m) < 0.0;
}

void SurfaceContact::seat(const Vec3& goal_m) noexcept {
    proxy_m_ = goal_m_ = goal_m;
    collected_m_ = -1.0;
    touches_ = false;
    easy_.forget();
    if (!mesh_.closed()) return;
    SurfacePoint nearest = mesh_.nearest(goal_m, 1e9, SurfacePoint::kNone, kSeatVisits);
    if (nearest.triangle == SurfacePoint::kNone || !inside(goal_m, nearest)) return;
    const Vec3 out = nearest.point_m - goal_m;
    const double depth = out.norm();
    const Vec3 normal = depth > 0.0 ? Vec3(out / depth) : mesh_.facet_normal(nearest.triangle);
    proxy_m_ = nearest.point_m + settings_.radius_m * normal;
    // Move away from other parts of the surface nearer than the radius; the half-spaces remove the remaining overlap.
    for (int i = 0; i < 8; ++i) {
        nearest = mesh_.nearest(proxy_m_, settings_.radius_m, nearest.triangle, kSeatVisits);
        if (nearest.triangle == SurfacePoint::kNone || !(nearest.distance_m > 0.0)) break;
        proxy_m_ +=
            (settings_.radius_m - nearest.distance_m) / nearest.distance_m * (proxy_m_ - nearest.point_m);
    }
    // No room outside, for example in a gap narrower than the ball: inside, it is free.
    nearest = mesh_.nearest(proxy_m_, settings_.radius_m, nearest.triangle, kSeatVisits);
    const bool in_triangles = nearest.triangle != SurfacePoint::kNone &&
                              nearest.distance_m < settings_.radius_m - 0.5 * settings_.margin_m;
    if (in_triangles && depth >= settings_.radius_m) proxy_m_ = goal_m;
}

}  // namespace tact
