#include "rt/force/surface/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tact {
namespace {

constexpr double kFollowedSteps = 1.5;  // a proxy on a slope travels farther than the goal
constexpr double kNextMove = 0.3;
constexpr double kGoesOn = 1.5;  // next reach after a cut move, in lengths of its remainder
constexpr double kSlidesOn = 1.15;
constexpr double kStaysSteps = 3.0;  // a facet that holds for so many steps is worth a list of its neighbours
constexpr int kRounds = 4;
constexpr int kNewtonSteps = 2;
constexpr double kNewtonMargins = 16.0, kNewtonRadii = 0.1;
constexpr double kNearerMargins = 0.05;
constexpr double kBorder = 0.1;  // margins: touches are judged again in double precision

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
      number_(4 * kLeavesMax + kLooks),
      full_tree_(mesh.tree().data()),
      whole_(!settings.brute) {}

double SurfaceContact::looks_m(const Vec3& goal_m) const noexcept {
    const double allowed = kFollowedSteps * (goal_m - goal_m_).norm() + settings_.lag_m;
    return settings_.radius_m + (1.0 + kCollectedMoves) * std::max(allowed, settings_.margin_m);
}

void SurfaceContact::use(const SurfaceMesh& mesh) noexcept {
    mesh_ = mesh;
    whole_ = !settings_.brute && mesh.tree().data() == full_tree_;
}

// Tries to prove rest after a move from the last query: with all triangles that the ball may touch, first those that bear
// the pull as far as single precision tells. Under a still
// hand and without friction, up to two short steps to the minimum replace whole moves.
bool SurfaceContact::prove(const HalfSpaces::Solution& bearing, Vec3 moved_m, double reach_m) noexcept {
    // A facet rests a margin above an edge.
    const double slack =
        (1.0 + RestProof::kBandMargins + kBorder) * settings_.margin_m + kBoundSlack * settings_.radius_m;
    const double newton_most_m =
        std::min(kNewtonMargins * settings_.margin_m, kNewtonRadii * settings_.radius_m);
    const Vec3 before_m = proxy_m_;
    for (int attempt = 0;; ++attempt) {
        proof_.begin(settings_.radius_m, settings_.margin_m);
        for (std::size_t i = 0; i < bearing.active_count; ++i)
            (void)proof_.add(mesh_, half_spaces_.triangle(bearing.active[i].half_space), proxy_m_);
        std::array<std::uint32_t, 4 * RestProof::kTouches> near;
        const std::size_t count = half_spaces_.near_after(moved_m, slack, near);
        for (std::size_t i = 0; i < count; ++i) {
            if (!proof_.add(mesh_, near[i], proxy_m_)) break;
        }
        proof_.solve(goal_m_ - proxy_m_);
        const bool touches = proof_.lift_m().squaredNorm() > 0.0;
        // After such a step the ball has to be as free as a query would leave it.
        if (touches && proof_.holds(settings_.friction) && (attempt == 0 || proof_.is_free())) {
            way_m_ += (proxy_m_ - before_m).norm();
            return true;
        }
        if (!touches || !still_ || settings_.friction > 0.0 || attempt == kNewtonSteps) break;
        const Vec3 newton_m = proof_.shape().newton_m;
        const double length = newton_m.norm();
        // Not beyond the reach of the query.
        if (!(length > 0.0 && length <= newton_most_m && (moved_m + newton_m).norm() <= reach_m)) break;
        proxy_m_ += newton_m;
        moved_m += newton_m;
    }
    proxy_m_ = before_m;
    return false;
}

// The move of a touching ball with friction, after touch_all().
Vec3 SurfaceContact::slide() const noexcept {
    const Vec3& lift = proof_.lift_m();
    const double push = lift.norm();
    const Vec3 normal = lift / push, onto = normal.dot(proof_.residual_m()) * normal,
               along = proof_.residual_m() - onto;
    const double length = along.norm(), held = settings_.friction * push;
    return length > held ? Vec3(onto + (1.0 - held / length) * along) : onto;
}

// Applies friction to the frictionless solution `free` of a ball that touched the surface before.
HalfSpaces::Solution SurfaceContact::held_back(const HalfSpaces::Solution& free, const Vec3& goal_m,
                                               double tolerance_m) const noexcept {
    const Vec3 lift = free.move_m - goal_m;
    const double depth = lift.norm();
    if (!(depth > 0.0) || free.active_count == 0) return free;
    const Vec3 normal = lift / depth;
    const Vec3 along = free.move_m - normal.dot(free.move_m) * normal;
    const double way = along.norm(), held = settings_.friction * depth;
    const Vec3 wanted = way > held ? Vec3(free.move_m - (held / way) * along) : Vec3(free.move_m - along);
    return half_spaces_.solve(wanted, tolerance_m);
}

bool SurfaceContact::step_easily(const Vec3& goal_m, double allowed_m, Contact& contact) noexcept {
    const EasyStep::Move move = easy_.move(proxy_m_, goal_m, settings_.friction);
    if (!move.known || !easy_.clear(move.to_m)) return false;
    const double moved = (move.to_m - proxy_m_).norm();
    if (moved > allowed_m) return false;
    proxy_m_ = contact.proxy_m = move.to_m;
    way_m_ += moved;
    moved_m_ = moved;
    touches_ = move.weight_m > 0.0;
    contact.moves = 1;
    if (touches_) {
        contact.planes = 1;
        contact.plane[0] = {easy_.normal(), move.weight_m, easy_.triangle()};
        contact.lift_m = move.weight_m * easy_.normal();
        contact.rub_m = move.rub_m;
    }
    return true;
}

// At the end of a settled step: fills the contact from the proof; on the facet of the step before, as an easy step would.
void SurfaceContact::settle(const Vec3& begin_m, Contact& contact) noexcept {
    contact.state = ContactState::settled;
    const RestProof::Touch* const facet = proof_.single_facet();
    if (facet != nullptr && easy_.has_facet(facet->triangle)) {
        const EasyStep::Move move = easy_.move(begin_m, goal_m_, settings_.friction);
        if (move.known && move.weight_m > 0.0 && (move.to_m - proxy_m_).norm() <= settings_.margin_m) {
            way_m_ += (move.to_m - proxy_m_).norm();
            proxy_m_ = move.to_m;
            contact.planes = 1;
            contact.plane[0] = {easy_.normal(), move.weight_m, facet->triangle};
            contact.lift_m = move.weight_m * easy_.normal();
            contact.rub_m = move.rub_m;
            return;
        }
    }
    list_proof(contact);
    contact.rub_m = proxy_m_ - goal_m_ - contact.lift_m;
}

// The heaviest three of the touches, and the sum of all.
void SurfaceContact::list_proof(Contact& contact) const noexcept {
    contact.planes = 0;
    for (const RestProof::Touch& t : proof_.touches()) {
        if (!(t.weight_m > 0.0)) continue;
        ContactPlane plane{t.normal, t.weight_m, t.triangle};
        for (std::uint32_t i = 0; i < contact.planes; ++i) {
            if (plane.weight_m > contact.plane[i].weight_m) std::swap(plane, contact.plane[i]);
        }
        if (contact.planes < contact.plane.size()) contact.plane[contact.planes++] = plane;
    }
    contact.lift_m = proof_.lift_m();
}

// The free path from here to all triangles but the touched facet, for easy steps.
void SurfaceContact::note_clear(const Contact& contact, const Vec3& begin_m) noexcept {
    touches_ &= contact.planes > 0;
    const RestProof::Touch* const facet = contact.planes == 1 ? proof_.single_facet() : nullptr;
    if (contact.state != ContactState::settled || (contact.planes > 0 && facet == nullptr)) {
        easy_.forget();
        return;
    }
    touches_ = facet != nullptr;
    if (facet != nullptr)
        easy_.set_facet(mesh_, facet->triangle, facet->normal, settings_.radius_m,
                        RestProof::kBandMargins * settings_.margin_m,
                        RestProof::kBorderMargins * settings_.margin_m);
    else
        easy_.leave(proxy_m_);
    if (settings_.brute || collected_m_ < 0.0) return;
    // Bounds of the nearest others, in order; the last entry is the one beyond them.
    std::array<float, EasyStep::kPlanes + 1> bound;
    std::array<std::uint32_t, EasyStep::kPlanes + 1> triangle;
    std::size_t count = 0;
    const bool stays = facet != nullptr && easy_.holds(proxy_m_, proxy_m_ - begin_m, kStaysSteps);
    const std::size_t most = stays ? bound.size() : 1;
    float least = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < collected_; ++i) {
        if (bound_m_[i] >= least || easy_.has_facet(triangle_[i])) continue;
        std::size_t at = count < most ? count++ : most - 1;
        for (; at > 0 && bound[at - 1] > bound_m_[i]; --at) {
            bound[at] = bound[at - 1];
            triangle[at] = triangle[at - 1];
        }
        bound[at] = bound_m_[i];
        triangle[at] = triangle_[i];
        if (count == most) least = bound[most - 1];
    }
    const double collected = collected_m_ - (proxy_m_ - collected_at_m_).norm();
    const auto free_m = [&](std::size_t i) {
        return i < count ? static_cast<double>(bound[i]) * (1.0 - kBoundSlack) - way_m_ - settings_.radius_m
                         : collected;
    };
    std::size_t above = 0;
    easy_.set_clear(proxy_m_, 0.0);
    while (stays && above < std::min(count, EasyStep::kPlanes) &&
           easy_.above(mesh_, triangle[above], proxy_m_, settings_.radius_m,
                       RestProof::kBorderMargins * settings_.margin_m))
        ++above;
    easy_.limit_clear(std::min(free_m(above), collected) - settings_.margin_m);
}

Contact SurfaceContact::follow(const Vec3& goal_m, std::uint32_t moves_max,
                               const Deadline& deadline) noexcept {
    Contact contact;
    const double step = kFollowedSteps * (goal_m - goal_m_).norm();
    goal_m_ = goal_m;
    still_ = step <= settings_.margin_m;
    const double allowed = step + settings_.lag_m;
    if (step_easily(goal_m, allowed, contact)) return contact;
    if (settings_.brute) collected_m_ = -1.0;
    const Vec3 begin_m = proxy_m_;
    Vec3 one_ago_m = proxy_m_, two_ago_m = Vec3::Constant(1e100);
    double left = allowed;
    double least_m = std::numeric_limits<double>::infinity();  // from the goal, of the moves
    bool cut_before = false;
    bool in_circle = false;  // the moves went round in a circle
    bool last = false;       // twice: only prove
    int rounds = 0;          // number of last moves that came no nearer to the goal
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
        bool slides = false;
        if (rubs || in_circle) {
            if (prove(half_spaces_.solve_nearest(request, tolerance), Vec3::Zero(), reach_now)) {
                settle(begin_m, contact);
                break;
            }
            slides = rubs && proof_.lift_m().squaredNorm() > 0.0;
        }
        if (last) {
            contact.state = ContactState::gliding;
            break;
        }
        const auto found = [&] {
            const Vec3 wanted = slides ? slide() : request;
            return in_circle ? half_spaces_.solve_nearest(wanted, tolerance)
                             : half_spaces_.solve(wanted, tolerance);
        };
        HalfSpaces::Solution move = found();
        if (!move.exact) {
            half_spaces_.allow_staying();
            move = found();
        }
        const bool free = move.active_count == 0 && !slides;
        if (slides) {
            list_proof(contact);
        } else {
            contact.planes = static_cast<std::uint32_t>(move.active_count);
            contact.lift_m.setZero();
            for (std::size_t i = 0; i < move.active_count; ++i) {
                const HalfSpaces::Active& a = move.active[i];
                contact.plane[i] = {a.normal, a.weight_m, half_spaces_.triangle(a.half_space)};
                contact.lift_m += a.weight_m * a.normal;
            }
            // Between two facets a ball that touched the first is held back too.
            if (rubs && touches_ && move.exact) move = held_back(move, request, tolerance);
        }
        touches_ |= slides;
        const double length = move.move_m.norm();
        const bool cut = length > reach_now;
        if (cut) move.move_m *= reach_now / length;
        const Vec3 moved_m =
            cut || length > kRestingMargins * settings_.margin_m ? move.move_m : Vec3(Vec3::Zero());
        proxy_m_ += moved_m;
        way_m_ += moved_m.norm();
        if (free && !cut) {
            way_m_ += (goal_m - proxy_m_).norm();
            proxy_m_ = goal_m;
            contact.state = ContactState::settled;
            break;
        }
        left = allowed - (proxy_m_ - begin_m).norm();
        if (!cut) {
            if (prove(move, moved_m, reach_now)) {
                settle(begin_m, contact);
                break;
            }
        }
        if (left <= settings_.margin_m) {
            contact.state = ContactState::gliding;
            break;
        }
        // Oscillation between two positions: the limits over a facet and over its edge differ by a margin. In a hollow
        // that just fits the ball, no direction is better within rounding and the moves go round in a ring.
        const double gap_m = (goal_m - proxy_m_).norm();
        rounds = gap_m > least_m - kNearerMargins * settings_.margin_m ? rounds + 1 : 0;
        least_m = std::min(least_m, gap_m);
        const bool circles =
            rounds == kRounds || (!cut && (proxy_m_ - two_ago_m).norm() <= settings_.margin_m);
        two_ago_m = one_ago_m;
        one_ago_m = proxy_m_;
        // The two half-spaces of a triangle led astray: go on with those of the nearest points, which descend steadily.
        if (circles) {
            last = in_circle;
            in_circle = true;
            rounds = 0;
            two_ago_m.setConstant(1e100);
        }
        // After a complete move only the curvature remains, so the next move is much shorter. After a cut move its
        // remainder is left; after two cut moves the distance is unknown.
        const double rest = kGoesOn * (length - reach_now), twice = 2.0 * reach_now;
        reach = std::max(!cut         ? kNextMove * length
                         : cut_before ? twice
                                      : std::min(twice, rest),
                         settings_.margin_m);
        cut_before = cut;
    }
    // Work spent on a circle does not count as lag: the proxy is near its goal. Below the maximum number of moves only
    // a second circle proves it.
    const bool all_used = contact.moves == kMovesMost || contact.triangles >= kTrianglesMost;
    if (contact.state == ContactState::lagging && !contact.late &&
        (last || (all_used && (rounds > 0 || in_circle))))
        contact.state = ContactState::gliding;
    if (contact.state != ContactState::settled) contact.rub_m = proxy_m_ - goal_m - contact.lift_m;
    moved_m_ = (proxy_m_ - begin_m).norm();
    contact.proxy_m = proxy_m_;
    contact.after_m = {after_m_.data(), std::max(contact.moves, 1U) - 1};
    note_clear(contact, begin_m);
    return contact;
}

}  // namespace tact
