#include "rt/force/surface/contact.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kCollectedMoves = 1.25;  // the ball of leaves reaches so many moves far
constexpr double kCollectedTooFar = 2.0;
constexpr std::size_t kLeavesFew = 32;
constexpr double kFollowedSteps = 1.5;  // a proxy on a slope travels farther than the goal
constexpr double kNextMove = 0.3;
constexpr double kRestingMargins = 0.02;
constexpr std::uint32_t kSeatVisits = 4096;  // of the tree: some 100 us

}  // namespace

SurfaceContact::SurfaceContact(const SurfaceMesh& mesh, const ContactSettings& settings)
    : mesh_(mesh), settings_(settings), leaf_(kLeavesMax) {}

// Leaves for moves of reach_m. Where they are too many the moves are made shorter; false: even the shortest
// has too many.
bool SurfaceContact::collect(double& reach_m) noexcept {
    const double moved = (proxy_m_ - collected_at_m_).norm();
    // Looking at a leaf costs some ten times as much as finding it, so many of them are found anew for a shorter
    // move.
    const bool too_many = leaves_ > kLeavesFew && collected_m_ - moved > kCollectedTooFar * reach_m;
    if (collected_m_ >= 0.0 && moved + reach_m <= collected_m_ && !too_many) return true;
    double wide = kCollectedMoves * reach_m;
    for (int attempt = 0; attempt < 12; ++attempt) {
        if (mesh_.leaves_near(proxy_m_, settings_.radius_m + wide, leaf_, leaves_)) {
            collected_at_m_ = proxy_m_;
            collected_m_ = wide;
            reach_m = std::min(reach_m, wide);
            return true;
        }
        wide *= attempt == 0 ? 1.0 / kCollectedMoves : 0.5;
    }
    collected_m_ = -1.0;
    return false;
}

// The guards of all triangles that a move of reach_m can touch; shorter, where there are too many.
void SurfaceContact::look(double& reach_m, std::uint32_t& triangles) noexcept {
    const double radius = settings_.radius_m, edge = radius - settings_.margin_m;
    LeafLook seen;
    for (int attempt = 0; attempt < 8; ++attempt) {
        guards_.clear();
        const auto limit = static_cast<float>(radius + reach_m);
        bool room = true;
        for (std::size_t l = 0; l < leaves_ && room; ++l) {
            mesh_.look(leaf_[l], proxy_m_, seen);
            const std::uint32_t first = SurfaceNode::leaf_first(leaf_[l]);
            for (std::uint32_t lane = 0; lane < 4 && room; ++lane) {
                const float distance = seen.distance_m[lane];
                if (!(distance < limit)) continue;
                const bool over = seen.over[lane] != 0.0F;
                // Out again by no more than a margin a move: what is inside is so by rounding, or was put
                // there.
                const auto slack = static_cast<float>(
                    std::max(static_cast<double>(distance) - (over ? radius : edge), -settings_.margin_m));
                const auto height = static_cast<float>(static_cast<double>(seen.height_m[lane]) - radius);
                room = guards_.add(first + lane, seen, lane, slack, height, !over && height >= 0.0F);
            }
        }
        triangles += static_cast<std::uint32_t>(4 * leaves_);
        if (room) return;
        reach_m *= 0.5;
    }
    reach_m = 0.0;
}

// Where friction leaves the proxy that would go to `free` without.
Vec3 SurfaceContact::held_back(const Guards::Solution& free, const Vec3& goal_m,
                               double tolerance_m) const noexcept {
    const Vec3 lift = free.move_m - goal_m;
    const double depth = lift.norm();
    if (!(depth > 0.0) || free.active_count == 0) return free.move_m;
    // It falls freely on what it does not touch yet.
    bool touches = false;
    for (std::size_t i = 0; i < free.active_count; ++i)
        touches |= free.active[i].slack_m <= 2.0 * settings_.margin_m + 0.01 * depth;
    if (!touches) return free.move_m;
    const Vec3 normal = lift / depth;
    const Vec3 along = free.move_m - normal.dot(free.move_m) * normal;
    const double way = along.norm(), held = settings_.friction * depth;
    const Vec3 wanted = way > held ? Vec3(free.move_m - (held / way) * along) : Vec3(free.move_m - along);
    return guards_.solve(wanted, tolerance_m).move_m;
}

Contact SurfaceContact::follow(const Vec3& goal_m, std::uint32_t moves_max, Instant deadline) noexcept {
    Contact contact;
    const double step = kFollowedSteps * (goal_m - goal_m_).norm();
    goal_m_ = goal_m;
    const Vec3 begin_m = proxy_m_;
    Vec3 one_ago_m = proxy_m_, two_ago_m = Vec3::Constant(1e100);
    const double allowed = step + settings_.glide_m;
    double left = allowed;
    double reach = std::max(step, settings_.margin_m);
    contact.state = ContactState::lagging;
    while (contact.moves < moves_max && contact.triangles < kTrianglesMost) {
        if (contact.moves > 0 && deadline != Instant::max() && Monotonic::now() >= deadline) {
            contact.late = true;
            break;
        }
        ++contact.moves;
        const Vec3 wish = goal_m - proxy_m_;
        double reach_now = std::min({reach, left, std::max(wish.norm(), settings_.margin_m)});
        if (!collect(reach_now)) break;
        look(reach_now, contact.triangles);
        // Single precision of a guard over the length of the wish, and of the distances.
        const double tolerance = 3e-7 * (wish.norm() + settings_.radius_m) + 1e-3 * settings_.margin_m;
        Guards::Solution free = guards_.solve(wish, tolerance);
        if (!free.exact) {
            guards_.allow_staying();
            free = guards_.solve(wish, tolerance);
        }
        contact.planes = static_cast<std::uint32_t>(free.active_count);
        for (std::size_t i = 0; i < free.active_count; ++i)
            contact.plane[i] = {free.active[i].normal, free.active[i].weight_m,
                                guards_.triangle(free.active[i].guard)};
        Vec3 move = settings_.friction > 0.0 ? held_back(free, wish, tolerance) : free.move_m;
        const double length = move.norm();
        const bool cut = length > reach_now;
        if (cut) move *= reach_now / length;
        // At rest it rests: what is left is rounding.
        if (cut || length > kRestingMargins * settings_.margin_m) proxy_m_ += move;
        left = allowed - (proxy_m_ - begin_m).norm();
        // To and fro between two places: the limits over a facet and over its edge differ by a margin.
        const bool to_and_fro = (proxy_m_ - two_ago_m).norm() <= settings_.margin_m;
        two_ago_m = one_ago_m;
        one_ago_m = proxy_m_;
        if (!cut && (free.active_count == 0 || to_and_fro || (free.exact && length <= settings_.margin_m))) {
            contact.state = ContactState::settled;
            break;
        }
        if (left <= settings_.margin_m) {
            contact.state = ContactState::gliding;
            break;
        }
        // A move that was not cut is followed by a much shorter one, as only the curvature is left.
        reach = cut ? 2.0 * reach_now : std::max(kNextMove * length, settings_.margin_m);
    }
    contact.proxy_m = proxy_m_;
    return contact;
}

// Of the triangles that share the nearest point, the one that the point is highest above tells the side
// (an edge's other triangle may be seen from behind).
bool SurfaceContact::inside(const Vec3& point_m, const SurfacePoint& nearest) noexcept {
    const double reach = nearest.distance_m * (1.0 + 1e-5);
    std::uint32_t teller = nearest.triangle;
    collected_m_ = -1.0;
    if (mesh_.leaves_near(point_m, reach, leaf_, leaves_)) {
        double highest = -1.0;
        for (std::size_t l = 0; l < leaves_; ++l) {
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
    if (!mesh_.closed()) return;
    SurfacePoint nearest = mesh_.nearest(goal_m, 1e9, SurfacePoint::kNone, kSeatVisits);
    if (nearest.triangle == SurfacePoint::kNone || !inside(goal_m, nearest)) return;
    const Vec3 out = nearest.point_m - goal_m;
    const double depth = out.norm();
    const Vec3 normal = depth > 0.0 ? Vec3(out / depth) : mesh_.facet_normal(nearest.triangle);
    proxy_m_ = nearest.point_m + settings_.radius_m * normal;
    // Where other parts of the surface are nearer than the radius, away from them; what is left the guards
    // push out.
    for (int i = 0; i < 8; ++i) {
        nearest = mesh_.nearest(proxy_m_, settings_.radius_m, nearest.triangle, kSeatVisits);
        if (nearest.triangle == SurfacePoint::kNone || !(nearest.distance_m > 0.0)) break;
        proxy_m_ +=
            (settings_.radius_m - nearest.distance_m) / nearest.distance_m * (proxy_m_ - nearest.point_m);
    }
}

}  // namespace tact
