#include "rt/force/surface/contact.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tact {
namespace {

constexpr double kCollectedMoves = 1.25;  // radius of the collected ball, in moves
constexpr double kCollectedTooFar = 8.0;
constexpr std::size_t kCollectedFew = 4096;
constexpr double kBoundSlack = 1e-5;    // relative rounding of distances in single precision
constexpr double kFollowedSteps = 1.5;  // a proxy on a slope travels farther than the goal
constexpr double kNextMove = 0.3;
constexpr double kGoesOn = 1.5;  // next reach after a cut move, in lengths of its remainder
constexpr double kSlidesOn = 1.15;
constexpr int kRounds = 4;
constexpr double kRestingMargins = 0.02;
constexpr double kNearerMargins = 0.05;
constexpr double kTangentMargins = 0.25;
constexpr std::uint32_t kSeatVisits = 4096;  // tree nodes, about 100 us

}  // namespace

SurfaceContact::SurfaceContact(const SurfaceMesh& mesh, const ContactSettings& settings)
    : mesh_(mesh),
      all_(mesh),
      settings_(settings),
      kernel_(&best_query_kernel()),
      leaf_(kLeavesMax),
      triangle_(4 * kLeavesMax),
      bound_m_(4 * kLeavesMax),
      slot_(4 * kLeavesMax + kLooks),
      number_(4 * kLeavesMax + kLooks) {}

double SurfaceContact::looks_m(const Vec3& goal_m) const noexcept {
    const double allowed = kFollowedSteps * (goal_m - goal_m_).norm() + settings_.lag_m;
    return settings_.radius_m + (1.0 + kCollectedMoves) * std::max(allowed, settings_.margin_m);
}

void SurfaceContact::use(const SurfaceMesh& mesh) noexcept { mesh_ = mesh; }

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
    double wide = kCollectedMoves * reach_m;
    for (int attempt = 0; attempt < 12; ++attempt) {
        if (find(settings_.radius_m + wide)) {
            std::fill_n(bound_m_.begin(), collected_, 0.0F);
            collected_at_m_ = proxy_m_;
            collected_m_ = wide;
            way_m_ = 0.0;
            reach_m = std::min(reach_m, wide);
            return true;
        }
        wide *= attempt == 0 ? 1.0 / kCollectedMoves : 0.5;
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

// True if every active triangle touches the ball at the solution and its normal there equals the assumed one: another
// move would find the same position. Inactive triangles are at least as far away as their half-spaces require.
bool SurfaceContact::rests(const HalfSpaces::Solution& solution) const noexcept {
    if (!solution.exact) return false;
    const double most = kTangentMargins * settings_.margin_m;
    std::array<std::uint32_t, 4> number{};
    for (std::size_t i = 0; i < number.size(); ++i)
        number[i] = half_spaces_.triangle(solution.active[i < solution.active_count ? i : 0].half_space);
    QueryJob job = mesh_.query_job(proxy_m_ + solution.move_m);
    job.triangle = number.data();
    TriangleQueries seen;
    query_four(job, seen);
    for (std::size_t i = 0; i < solution.active_count; ++i) {
        const HalfSpaces::Active& active = solution.active[i];
        const bool over = (seen.over >> i & 1U) != 0;
        const double rest = settings_.radius_m - (over ? 0.0 : settings_.margin_m);
        if (std::abs(static_cast<double>(seen.distance[i]) - rest) > most) return false;
        const Vec3 away(static_cast<double>(seen.away[0][i]), static_cast<double>(seen.away[1][i]),
                        static_cast<double>(seen.away[2][i]));
        if ((away - active.normal).norm() * active.weight_m > most) return false;
    }
    return true;
}

// Applies friction to the frictionless solution `free`.
HalfSpaces::Solution SurfaceContact::held_back(const HalfSpaces::Solution& free, const Vec3& goal_m,
                                               double tolerance_m) const noexcept {
    const Vec3 lift = free.move_m - goal_m;
    const double depth = lift.norm();
    if (!(depth > 0.0) || free.active_count == 0) return free;
    // No friction before contact.
    bool touches = false;
    for (std::size_t i = 0; i < free.active_count; ++i)
        touches |= free.active[i].slack_m <= 2.0 * settings_.margin_m + 0.01 * depth;
    if (!touches) return free;
    const Vec3 normal = lift / depth;
    const Vec3 along = free.move_m - normal.dot(free.move_m) * normal;
    const double way = along.norm(), held = settings_.friction * depth;
    const Vec3 wanted = way > held ? Vec3(free.move_m - (held / way) * along) : Vec3(free.move_m - along);
    return half_spaces_.solve(wanted, tolerance_m);
}

Contact SurfaceContact::follow(const Vec3& goal_m, std::uint32_t moves_max,
                               const Deadline& deadline) noexcept {
    Contact contact;
    const double step = kFollowedSteps * (goal_m - goal_m_).norm();
    goal_m_ = goal_m;
    if (settings_.brute) collected_m_ = -1.0;
    const Vec3 begin_m = proxy_m_;
    Vec3 one_ago_m = proxy_m_, two_ago_m = Vec3::Constant(1e100);
    const double allowed = step + settings_.lag_m;
    double left = allowed;
    double least_m = std::numeric_limits<double>::infinity();  // from the goal, of the moves
    bool cut_before = false;
    int rounds = 0;  // number of last moves that came no nearer to the goal
    // Expect the slide to continue at its speed; a second move covers the rest.
    double reach = std::max(std::min(step, kSlidesOn * moved_m_), settings_.margin_m);
    contact.state = ContactState::lagging;
    moves_max = std::min(moves_max, kMovesMost);
    while (contact.moves < moves_max && contact.triangles < kTrianglesMost) {
        if (contact.moves > 0 && deadline.passed()) {
            contact.late = true;
            break;
        }
        if (contact.moves > 0) after_m_[contact.moves - 1] = proxy_m_;
        ++contact.moves;
        const Vec3 request = goal_m - proxy_m_;
        double reach_now = std::min({reach, left, std::max(request.norm(), settings_.margin_m)});
        if (!collect(reach_now)) break;
        // With friction, the frictionless position depends only on half-spaces in reach, not on what was collected.
        const bool rubs = settings_.friction > 0.0;
        const double room = collected_m_ - (proxy_m_ - collected_at_m_).norm();
        query(reach_now, rubs ? 0.0 : std::min({room, left, std::max(request.norm(), settings_.margin_m)}),
              contact.triangles);
        // Single precision of a half-space over the length of the request, and of the distances.
        const double tolerance = 3e-7 * (request.norm() + settings_.radius_m) + 1e-3 * settings_.margin_m;
        HalfSpaces::Solution free = half_spaces_.solve(request, tolerance);
        if (!free.exact) {
            half_spaces_.allow_staying();
            free = half_spaces_.solve(request, tolerance);
        }
        contact.planes = static_cast<std::uint32_t>(free.active_count);
        for (std::size_t i = 0; i < free.active_count; ++i)
            contact.plane[i] = {free.active[i].normal, free.active[i].weight_m,
                                half_spaces_.triangle(free.active[i].half_space)};
        const HalfSpaces::Solution held = rubs ? held_back(free, request, tolerance) : free;
        Vec3 move = held.move_m;
        const double length = move.norm();
        const bool cut = length > reach_now;
        const bool small = free.exact && length <= settings_.margin_m;
        const bool at_rest = !cut && (small || (rests(free) && (!rubs || rests(held))));
        if (cut) move *= reach_now / length;
        // Shorter moves are rounding noise; the proxy stays at rest.
        if (cut || length > kRestingMargins * settings_.margin_m) {
            proxy_m_ += move;
            way_m_ += move.norm();
        }
        left = allowed - (proxy_m_ - begin_m).norm();
        // Oscillation between two positions: the limits over a facet and over its edge differ by a margin.
        const bool to_and_fro = (proxy_m_ - two_ago_m).norm() <= settings_.margin_m;
        two_ago_m = one_ago_m;
        one_ago_m = proxy_m_;
        if (!cut && (free.active_count == 0 || to_and_fro || at_rest)) {
            contact.state = ContactState::settled;
            break;
        }
        if (left <= settings_.margin_m) {
            contact.state = ContactState::gliding;
            break;
        }
        // In a hollow that just fits the ball, no direction is better within rounding and the moves go round in a ring.
        const double gap_m = (goal_m - proxy_m_).norm();
        rounds = gap_m > least_m - kNearerMargins * settings_.margin_m ? rounds + 1 : 0;
        least_m = std::min(least_m, gap_m);
        if (rounds == kRounds) break;
        // After a complete move only the curvature remains, so the next move is much shorter. After a cut move its
        // remainder is left; after two cut moves the distance is unknown.
        const double rest = kGoesOn * (length - reach_now), twice = 2.0 * reach_now;
        reach = std::max(!cut         ? kNextMove * length
                         : cut_before ? twice
                                      : std::min(twice, rest),
                         settings_.margin_m);
        cut_before = cut;
    }
    // Moves spent on a ring do not count as lag: the proxy is at its goal within a margin. Below the maximum number of moves
    // only a full count of rounds proves a ring.
    const bool ring = rounds == kRounds || (rounds > 0 && contact.moves == kMovesMost);
    if (contact.state == ContactState::lagging && ring && !contact.late)
        contact.state = ContactState::settled;
    moved_m_ = (proxy_m_ - begin_m).norm();
    contact.proxy_m = proxy_m_;
    contact.after_m = {after_m_.data(), std::max(contact.moves, 1U) - 1};
    return contact;
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
}

}  // namespace tact
