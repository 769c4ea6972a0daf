#include "rt/force/surface/tool_contact.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tact {
namespace {

constexpr std::size_t kBeyondAtOnce = 48;
constexpr int kMoveRounds = 12;
constexpr double kGoneSteps = 1.5;   // a proxy on a slope travels farther than the goal
constexpr double kLookedWays = 1.3;  // reach of a triangle query, in displacements of the point
constexpr double kAskedRooms =
    4.0;  // points with a bound above this many displacements get a cheap query first
constexpr double kFirstMoves = 2.0;  // longest first move of a step, in longest moves of the last step
constexpr double kGrows = 4.0;       // growth of the longest move after a cut move
constexpr double kNextMoves = 3.0;   // longest move after an uncut move, in lengths of that move
constexpr double kShrinks = 0.5;     // factor after a move without room for its half-spaces
constexpr double kLeastMargins = 8.0;
constexpr double kTouchMargins = 2.0;  // a triangle no farther than this bears
constexpr double kAtRestMargins = 0.1;
constexpr double kSunkTurn = 0.5;    // a turn of half the size sinks a point by a quarter of a margin
constexpr double kTurnedMost = 0.1;  // of a normal: two margins beyond an edge
constexpr double kReturns = 0.5;     // of the last move, or less: the move before it is undone
constexpr double kFarM = 1e3;

Vec3 linear(const Vec6& y) { return y.head<3>(); }

}  // namespace

ToolContact::ToolContact(const SurfaceMesh& mesh, const TouchTool& tool, const ToolContactSettings& settings)
    : mesh_(mesh),
      settings_(settings),
      points_(mesh, tool, settings.ball_m, settings.brute),
      kernel_(&best_query_kernel()),
      lists_(mesh, points_.size(), settings.brute),
      beyond_(kBeyondAtOnce),
      // An arc of angle a leaves its tangent by a^2 / 2 of its radius.
      turn_max_rad_(std::min(std::sqrt(2.0 * settings.margin_m / points_.reach_m()), 0.2)) {}

Vec6 ToolContact::way_m(const Pose& from, const Pose& to) const noexcept {
    Vec6 way;
    way << to.p_m - from.p_m,
        points_.gyration_m() * rotation_vector_rad((to.q * from.q.conjugate()).normalized());
    return way;
}

void ToolContact::seat(const Pose& goal) noexcept {
    goal_ = proxy_ = {goal.p_m, goal.q.normalized()};
    proxy_.p_m = points_.seat(proxy_);
    held_count_ = 0;
    last_move_m_ = 0.0;
    seating_ = kSeatingMost;
}

// Adds the half-spaces of all triangles that a point's ball can touch within reach_m; shortens the reach if there are too
// many.
bool ToolContact::query(std::uint32_t point, double reach_m, ToolTouch& touch) noexcept {
    const Vec3 place = points_.place_m(point);
    const Eigen::Vector3f lever = points_.lever_m(point) / static_cast<float>(points_.gyration_m());
    const double ball = settings_.ball_m, edge = ball - settings_.margin_m,
                 sunk = SurfaceContact::kSunkMargins * settings_.margin_m;
    QueryJob job = mesh_.query_job(place);
    SeenTriangles one;  // if the list is not kept
    for (int attempt = 0; attempt < 6; ++attempt) {
        if (attempt > 0) reach_m *= 0.5;
        ++touch.looked;
        const ToolLists::Near list = lists_.near(point, place, ball + reach_m);
        if (!(list.radius_m > 0.0)) continue;
        job.limit = static_cast<float>(ball + reach_m);
        double least = list.radius_m;
        for (std::size_t first = 0; first < list.count; first += kLooks) {
            SeenTriangles& block = list.seen != nullptr ? list.seen[first / kLooks] : one;
            if (list.seen != nullptr) {
                const double known = block.coarse_m(place);
                if (known > ball + reach_m) {
                    least = std::min(least, known);
                    continue;
                }
            }
            const std::size_t lanes = std::min(kLooks, list.count - first);
            TriangleQueries& seen = block.seen;
            job.triangle = list.triangle + first;
            kernel_->query(job, seen);
            // The lanes beyond the last triangle repeat the first one.
            block.place_m = place;
            block.least_m =
                static_cast<double>(*std::min_element(std::begin(seen.distance), std::end(seen.distance)));
            least = std::min(least, block.least_m);
            std::uint32_t near = seen.near & ((lanes < kLooks ? 1U << lanes : 0U) - 1U);
            for (; near != 0; near &= near - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(near));
                const double distance = static_cast<double>(seen.distance[lane]),
                             height = static_cast<double>(seen.height[lane]) - ball;
                const bool over = (seen.over >> lane & 1U) != 0;
                sunk_m_ = std::max(sunk_m_, edge - distance);
                // Push out by at most one margin per move.
                const double slack = std::max(distance - (over ? ball : edge), -settings_.margin_m);
                if (!half_spaces_.add(point, list.triangle[first + lane], lever, seen, lane,
                                      static_cast<float>(slack), static_cast<float>(std::max(height, -sunk)),
                                      !over && height >= -sunk))
                    return false;
            }
        }
        points_.saw(point, least * (1.0 - 1e-6), reach_m);
        return true;
    }
    return false;
}

// True if what queries found around a point before shows that it may go there.
bool ToolContact::is_known_free(std::uint32_t point, const Vec3& v_m, const Vec3& w_rad,
                                double way_m) noexcept {
    const Vec3 begin = points_.place_m(point),
               displacement = v_m + w_rad.cross(points_.lever_m(point).cast<double>());
    const double ball = settings_.ball_m;
    const SeenTriangles::Clearance clear =
        lists_.clearance_m(point, begin, begin + displacement, ball + way_m + settings_.margin_m);
    points_.clears(point, clear.begin_m);
    if (points_.room_m(point) >= way_m) return true;
    const double over = clear.way_m - ball - settings_.margin_m;
    if (!(over > 0.0)) return false;
    points_.passes(point, displacement, over);
    return true;
}

// Friction is that of the triangles touched now. Those that the tool would touch at the end of the move bear nothing yet: with
// them the cone would be too wide, and a tool would stick to one wall because another is near.
Vec6 ToolContact::held_back(const TwistHalfSpaces::Solution& touched, const Vec6& goal_m,
                            const TwistHalfSpaces::Rules& rules,
                            TwistHalfSpaces::Solution& held) const noexcept {
    const Vec6 lift = touched.move_m - goal_m;
    const double depth = lift.norm();
    const Vec6 normal = lift / depth;
    const Vec6 along = touched.move_m - normal.dot(touched.move_m) * normal;
    const double way = along.norm(), most = settings_.friction * depth;
    const Vec6 wanted =
        way > most ? Vec6(touched.move_m - (most / way) * along) : Vec6(touched.move_m - along);
    held = TwistHalfSpaces::fresh(wanted);
    half_spaces_.solve(wanted, rules, held);
    return held.move_m;
}

// A tool beside a triangle may be held by its plane, for the move that it would make. What it touches bears in another direction, and
// friction that suffices in the one need not in the other: no proof of a rest.
bool ToolContact::bears_as_touched(const TwistHalfSpaces::Solution& touched) const noexcept {
    return std::none_of(touched.active.begin(),
                        touched.active.begin() + static_cast<std::ptrdiff_t>(touched.active_count),
                        [&](const auto& a) { return half_spaces_.turned_by(a) > kTurnedMost; });
}

void ToolContact::list_places(const TwistHalfSpaces::Solution& solution, ToolTouch& touch) const noexcept {
    touch.places = 0;
    for (std::size_t i = 0; i < solution.active_count; ++i) {
        const TwistHalfSpaces::Active& a = solution.active[i];
        const std::uint32_t point = half_spaces_.point(a.half_space);
        touch.place[touch.places++] = {points_.lever_m(point).cast<double>(), linear(a.normal), a.weight_m,
                                       point, half_spaces_.triangle(a.half_space)};
    }
}

// The points to begin the next move with: those that bear, and those that end this move.
void ToolContact::hold(const TwistHalfSpaces::Solution& bears,
                       const TwistHalfSpaces::Solution& ends) noexcept {
    held_count_ = 0;
    for (const auto* s : {&bears, &ends}) {
        for (std::size_t i = 0; i < s->active_count; ++i) {
            const std::uint32_t point = half_spaces_.point(s->active[i].half_space);
            const auto end = held_.begin() + static_cast<std::ptrdiff_t>(held_count_);
            if (std::find(held_.begin(), end, point) == end) held_[held_count_++] = point;
        }
    }
}

ToolContact::Move ToolContact::find_move(const Vec6& request, double left_m, ToolTouch& touch,
                                         const Deadline& deadline) noexcept {
    for (;;) {
        const double tried_m = std::min(left_m, longest_m_);
        Move move = find_move_within(request, tried_m, touch, deadline);
        if (!move.full) {
            longest_m_ = move.cut ? kGrows * tried_m
                                  : std::max(kNextMoves * move.y.norm(), kLeastMargins * settings_.margin_m);
            return move;
        }
        // The number of triangles in reach grows with the square of the move's length.
        longest_m_ = kShrinks * tried_m;
        if (longest_m_ < settings_.margin_m || touch.late || touch.looked >= queries_most_) return move;
    }
}

ToolContact::Move ToolContact::find_move_within(const Vec6& request, double left_m, ToolTouch& touch,
                                                const Deadline& deadline) noexcept {
    const double gyration = points_.gyration_m();
    const auto twist = [&](const Vec6& y) {
        return std::pair<Vec3, Vec3>(y.head<3>(), y.tail<3>() / gyration);
    };
    points_.begin_move(proxy_);
    half_spaces_.clear();
    sunk_m_ = 0.0;
    bool room = true;
    const double expected = std::clamp(kLookedWays * last_move_m_, 4.0 * settings_.margin_m,
                                       std::max(left_m, 4.0 * settings_.margin_m));
    for (std::size_t i = 0; i < held_count_ && room; ++i) {
        if (points_.is_awake(held_[i])) room = query(held_[i], expected, touch);
    }
    // Single precision of a half-space over the length of the request.
    const double tolerance = 6e-7 * (request.norm() + settings_.ball_m) + 1e-3 * settings_.margin_m;
    const TwistHalfSpaces::Rules rules{tolerance},
        touching{tolerance, static_cast<float>(kTouchMargins * settings_.margin_m)};
    TwistHalfSpaces::Solution free = TwistHalfSpaces::fresh(request);
    Move move;
    for (int round = 0;; ++round) {
        half_spaces_.solve(request, rules, free);
        if (!free.exact) {
            half_spaces_.allow_staying();
            free = TwistHalfSpaces::fresh(request);
            half_spaces_.solve(request, rules, free);
        }
        TwistHalfSpaces::Solution best = free;
        half_spaces_.turn(request, rules, best);
        move.y = best.move_m;
        move.exact = best.exact;
        TwistHalfSpaces::Solution held;
        if (settings_.friction > 0.0) {
            TwistHalfSpaces::Solution touched = TwistHalfSpaces::fresh(request);
            half_spaces_.solve(request, touching, touched);
            half_spaces_.turn(request, touching, touched);
            if (touched.exact && touched.active_count > 0) {
                move.y = held_back(touched, request, rules, held);
                best = touched;
            }
            move.exact &= touched.exact && held.exact && bears_as_touched(touched);
        }
        const double length = move.y.norm(), turned = move.y.tail<3>().norm() / gyration;
        const double turn_most_rad = sunk_m_ > 0.0 ? kSunkTurn * turn_max_rad_ : turn_max_rad_;
        const double share =
            std::min({1.0, left_m / std::max(length, 1e-300), turn_most_rad / std::max(turned, 1e-300)});
        move.cut = share < 1.0;
        if (move.cut) move.y *= share;
        const auto [v, w] = twist(move.y);
        list_places(best, touch);
        hold(best, held);
        const std::size_t count = points_.beyond(v, w, beyond_);
        if (count == 0) return move;
        const bool late = deadline.passed();
        touch.late |= late;
        if (late || !room || round == kMoveRounds || touch.looked >= queries_most_ ||
            touch.asked >= queries_most_)
            break;
        for (std::size_t k = 0; k < count && room; ++k) {
            const std::uint32_t i = beyond_[k];
            if (touch.looked >= queries_most_ || touch.asked >= queries_most_) break;
            const double way = points_.way_m(i, v, w);
            // Update the distance bound of far points; query triangles only for near ones.
            if (points_.recall(i, way) || is_known_free(i, v, w, way)) continue;
            if (points_.asked_m(i) > kAskedRooms * way + settings_.ball_m) {
                ++touch.asked;
                points_.ask(i, way);
                if (points_.room_m(i) >= way) continue;
            }
            room = query(i, kLookedWays * way, touch);
        }
    }
    move.full = !room;
    // Move only as far as known to be free.
    const auto [v, w] = twist(move.y);
    const double share = points_.share_in_room(v, w);
    if (share < 1.0) {
        move.y *= 0.999 * share;
        move.short_ = true;
    }
    return move;
}

ToolTouch ToolContact::follow(const Pose& goal, const Limits& limits, const Deadline& deadline,
                              const NearSurface* near) noexcept {
    ToolTouch touch;
    queries_most_ = limits.queries;
    lists_.begin_step(near);
    longest_m_ = std::max(kFirstMoves * last_move_m_, kLeastMargins * settings_.margin_m);
    const Pose to{goal.p_m, goal.q.normalized()};
    // While it is seated, the proxy comes step by step. Later its way is not limited: the force has a pace of its own.
    const double gone_goal = kGoneSteps * way_m(goal_, to).norm();
    const double allowed = seating_ > 0 ? gone_goal + points_.reach_m() / kSeatSteps : kFarM;
    const double longest = gone_goal + settings_.lag_m;
    goal_ = to;
    if (seating_ > 0) --seating_;
    points_.wake(proxy_, limits.points, std::span(held_).first(held_count_),
                 points_.tried_all() ? kWakeQueries : kSeatQueries);
    touch.T_model_proxy = proxy_;
    touch.state = ContactState::lagging;
    if (!points_.tried_all()) {
        touch.state = ContactState::gliding;
        return touch;
    }
    const Pose begin = proxy_;
    Pose one_ago = proxy_, two_ago{Vec3::Constant(kFarM), Quat::Identity()};
    double left = allowed;
    double gone = 0.0;
    while (touch.moves < limits.moves && touch.looked < queries_most_ && touch.asked < queries_most_ &&
           !touch.late) {
        ++touch.moves;
        const Move move = find_move(way_m(proxy_, to), std::min(left, longest), touch, deadline);
        const double length = move.y.norm();
        if (move.cut || move.short_ || length > SurfaceContact::kRestingMargins * settings_.margin_m) {
            proxy_.p_m += move.y.head<3>();
            proxy_.q =
                (quat_from_rotation_vector(move.y.tail<3>() / points_.gyration_m()) * proxy_.q).normalized();
        }
        gone = std::max(gone, length);
        last_move_m_ = length;
        left = allowed - way_m(begin, proxy_).norm();
        if (move.short_) {
            if (length <= settings_.margin_m) break;
            continue;
        }
        const double back = way_m(two_ago, proxy_).norm();
        two_ago = one_ago;
        one_ago = proxy_;
        // At rest, or to and fro within a margin. A move that is merely short may end beyond an edge over which the tool then
        // falls, or be one of many: the next one shows it.
        const bool is_short = length <= settings_.margin_m, returned = back <= kReturns * length;
        const bool ends =
            touch.places == 0 || length <= kAtRestMargins * settings_.margin_m || (is_short && returned);
        if (!move.cut && (ends || (!is_short && back <= settings_.margin_m))) {
            // A tool that goes to and fro farther, or whose half-spaces could not be solved, may have a rest elsewhere.
            touch.state = ends && move.exact ? ContactState::settled : ContactState::gliding;
            seating_ = 0;
            break;
        }
        if (left <= settings_.margin_m) {
            touch.state = ContactState::gliding;
            break;
        }
    }
    last_move_m_ = gone;  // for the first move of the next step
    touch.adaptive = near != nullptr && !lists_.elsewhere();
    touch.T_model_proxy = proxy_;
    return touch;
}

}  // namespace tact
