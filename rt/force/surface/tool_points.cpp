#include "rt/force/surface/tool_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tact {
namespace {

// A query first searches within this fraction of the distance to the last found triangle. Usually nothing is nearer,
// and the search visits few nodes.
constexpr double kAskedShare = 0.75;
constexpr double kFarAway = 1e9;
constexpr int kQueryTries = 6;
constexpr double kAtMost = 32.0;           // search radius of a distance query, in displacements of the point
constexpr std::uint32_t kWayQueries = 24;  // per path between two points
constexpr double kFreeShare = 0.5;         // fraction of a ball's radius; nearer to the surface is not free
constexpr std::uint32_t kRootsTried = 8;
constexpr int kRaises = 16;
constexpr float kNearlyBeyond = 1.0F - 1e-5F;  // share of the room; covers the rounding of single precision
constexpr double kKnownCells = 0.12;           // edge of the cells of known places, in reaches of the tool
constexpr float kRounding = 4e-7F;             // relative rounding of the coordinates

std::size_t filled_up(std::uint32_t count) {
    return (std::size_t{count} + kPointBlock - 1) / kPointBlock * kPointBlock;
}

}  // namespace

ToolPoints::ToolPoints(const SurfaceMesh& mesh, const TouchTool& tool, double ball_m, bool brute)
    : mesh_(mesh),
      all_(mesh),
      brute_(brute),
      ball_m_(ball_m),
      count_(static_cast<std::uint32_t>(tool.points())),
      parent_(tool.parent),
      hint_(count_, SurfacePoint::kNone),
      cover_m_(tool.cover_m),
      bound_(filled_up(count_), -1.0F),
      room_(filled_up(count_), 0.0F),
      known_(1.0),
      passed_(count_),
      kernels_(&best_point_kernels()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (auto* row : {&local_[axis], &lever_[axis], &asked_[axis]}) row->assign(filled_up(count_), 0.0F);
        for (std::size_t i = 0; i < count_; ++i) local_[axis][i] = tool.point_m[3 * i + axis];
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const double square = tool.at_m(i).squaredNorm();
        sum += square;
        reach_m_ = std::max(reach_m_, std::sqrt(square));
    }
    // A tool with one point at the hand point rotates freely, but still needs a length scale.
    gyration_m_ = std::max(std::sqrt(sum / count_), ball_m_);
    reach_m_ += ball_m_;
    known_ = KnownPlaces(kKnownCells * reach_m_);
}

void ToolPoints::turn_levers(const Pose& pose, std::uint32_t points) noexcept {
    hand_m_ = pose.p_m;
    const Eigen::Matrix3f r = pose.q.toRotationMatrix().cast<float>();
    const std::size_t n = filled_up(points);
    const float *const x = local_[0].data(), *const y = local_[1].data(), *const z = local_[2].data();
    for (int axis = 0; axis < 3; ++axis) {
        float* const out = lever_[axis].data();
        const float a = r(axis, 0), b = r(axis, 1), c = r(axis, 2);
        for (std::size_t i = 0; i < n; ++i) out[i] = a * x[i] + b * y[i] + c * z[i];
    }
}

Vec3 ToolPoints::place_m(std::uint32_t i) const noexcept { return hand_m_ + lever_m(i).cast<double>(); }

void ToolPoints::sleep(std::uint32_t i) noexcept {
    if (is_known(i)) --awake_;
    bound_[i] = -1.0F;
}

void ToolPoints::put(std::uint32_t i, double distance_m, std::uint32_t hint) noexcept {
    if (!is_known(i)) ++awake_;
    bound_[i] = static_cast<float>(std::clamp(distance_m, 0.0, kFarAway));
    const Eigen::Vector3f from_anchor = (hand_m_ - anchor_m_).cast<float>() + lever_m(i);
    for (std::size_t axis = 0; axis < 3; ++axis)
        asked_[axis][i] = from_anchor[static_cast<Eigen::Index>(axis)];
    if (hint != SurfacePoint::kNone) hint_[i] = hint;
}

double ToolPoints::bound_now_m(std::uint32_t i) const noexcept {
    const Eigen::Vector3f from_anchor = (hand_m_ - anchor_m_).cast<float>() + lever_m(i);
    const Eigen::Vector3f asked(asked_[0][i], asked_[1][i], asked_[2][i]);
    return static_cast<double>(bound_[i] - (from_anchor - asked).norm());
}

ToolPoints::Seen ToolPoints::query(const Vec3& place_m, std::uint32_t hint) const noexcept {
    double above = kFarAway;
    if (hint < mesh_.triangles()) above = mesh_.point_of(hint, place_m).distance_m;
    double asked = hint < mesh_.triangles() ? kAskedShare * above : kFarAway;
    for (int attempt = 0; attempt < kQueryTries; ++attempt, asked *= 0.4) {
        const SurfacePoint found = mesh_.nearest(place_m, asked, SurfacePoint::kNone, kVisits);
        if (found.exhausted) {
            asked = std::min(asked, found.distance_m);
            if (found.triangle != SurfacePoint::kNone) hint = found.triangle;
            continue;
        }
        if (found.triangle != SurfacePoint::kNone) hint = found.triangle;
        return {found.distance_m * (1.0 - 1e-6), hint};
    }
    return {0.0, hint};  // unknown
}

// Moves the tool to a position where the ball about the hand point that contains the whole tool is free: one query
// bounds the distances of all points.
bool ToolPoints::seat_freely(const Pose& pose, Vec3& hand_m) noexcept {
    hand_m = pose.p_m;
    const double wanted = reach_m_ + 4.0 * ball_m_;
    for (int i = 0; i < kRaises; ++i) {
        const SurfacePoint found = mesh_.nearest(hand_m, kFarAway, hint_[0], 4 * kVisits);
        if (found.triangle == SurfacePoint::kNone) return false;
        hint_[0] = found.triangle;
        const Vec3 away = hand_m - found.point_m, normal = mesh_.normal_at(found);
        const bool inside = mesh_.closed() && away.dot(normal) < 0.0;
        if (!inside && found.distance_m >= wanted) {
            const double free_m = reach_m_ + 3.0 * ball_m_;
            const SurfacePoint nearer = mesh_.nearest(hand_m, free_m, SurfacePoint::kNone, 4 * kVisits);
            if (nearer.triangle != SurfacePoint::kNone || nearer.exhausted) return false;
            anchor_m_ = hand_m;
            turn_levers({hand_m, pose.q}, count_);
            root_ = 0;
            put(0, free_m - lever_m(0).cast<double>().norm(), found.triangle);
            return true;
        }
        const bool straight = !inside && found.distance_m > ball_m_;
        hand_m = found.point_m + 1.05 * wanted * (straight ? Vec3(away / found.distance_m) : normal);
    }
    return false;
}

// Wakes one point: outside a closed surface, or on the side of an open one where most of the first points are.
void ToolPoints::seat_one(Pose pose, Vec3& hand_m) noexcept {
    const std::uint32_t tried = std::min(kRootsTried, count_);
    std::array<std::uint32_t, 2> first{count_, count_},
        found_there{};  // in front of the surface, and behind it
    SurfacePoint found;
    Vec3 normal = Vec3::Zero();
    hand_m = anchor_m_ = pose.p_m;
    turn_levers(pose, count_);
    for (std::uint32_t i = 0; i < tried; ++i) {
        found = mesh_.nearest(place_m(i), kFarAway, hint_[0], 4 * kVisits);
        if (found.triangle == SurfacePoint::kNone) return;
        hint_[0] = found.triangle;
        normal = mesh_.normal_at(found);
        const double clear = (place_m(i) - found.point_m).dot(normal);
        if (std::abs(clear) < 0.2 * found.distance_m || found.distance_m < kFreeShare * ball_m_) continue;
        const std::size_t side = clear > 0.0 ? 0 : 1;
        if (found_there[side]++ == 0) first[side] = i;
    }
    const std::size_t side = mesh_.closed() || found_there[0] >= found_there[1] ? 0 : 1;
    root_ = first[side];
    if (root_ == count_) {  // none: move the whole tool until the last tried point is outside
        root_ = tried - 1;
        hand_m += found.point_m + 2.0 * ball_m_ * normal - place_m(root_);
        anchor_m_ = pose.p_m = hand_m;
        turn_levers(pose, count_);
    }
    put(root_, query(place_m(root_), hint_[0]).distance_m, hint_[0]);
}

Vec3 ToolPoints::seat(const Pose& pose) noexcept {
    std::fill(bound_.begin(), bound_.end(), -1.0F);
    awake_ = next_ = points_ = 0;
    tried_all_ = false;
    root_counts_ = true;
    Vec3 hand_m;
    if (!seat_freely(pose, hand_m)) seat_one(pose, hand_m);
    return hand_m;
}

bool ToolPoints::way_is_free(const Vec3& from_m, double free_m, const Vec3& to_m, std::uint32_t& hint,
                             double& free_there_m, std::uint32_t& queries) const noexcept {
    const double length = (to_m - from_m).norm();
    double gone = 0.0;
    while (queries > 0) {
        if (free_m < kFreeShare * ball_m_) return false;
        // The centre of the next ball lies inside the last ball.
        gone = std::min(gone + free_m - 0.5 * kFreeShare * ball_m_, length);
        const Vec3 place = length > 0.0 ? Vec3(from_m + gone / length * (to_m - from_m)) : to_m;
        const Seen seen = query(place, hint);
        --queries;
        free_m = seen.distance_m;
        hint = seen.triangle;
        if (gone >= length) {
            free_there_m = free_m;
            return free_m >= kFreeShare * ball_m_;
        }
    }
    return false;
}

bool ToolPoints::try_to_wake(std::uint32_t i, std::uint32_t& queries) noexcept {
    std::uint32_t from = parent_[i];
    if (from == i || !is_known(from)) from = root_;
    if (from == i || !is_known(from)) return false;
    const Vec3 start = place_m(from), end = place_m(i);
    const double way = (end - start).norm(), free = bound_now_m(from);
    std::uint32_t hint = hint_[from];
    if (free - way > ball_m_) {
        put(i, free - way, hint);
        return true;
    }
    if (queries < 2) return false;
    std::uint32_t allowed = std::min(queries, kWayQueries);
    queries -= allowed;
    double there = 0.0;
    const Seen seen = query(start, hint);
    --allowed;
    hint = seen.triangle;
    bool is_free = false;
    if (way < 8.0 * ball_m_ || seen.distance_m > way) {
        is_free = way_is_free(start, seen.distance_m, end, hint, there, allowed);
    } else if (hint < mesh_.triangles()) {
        // Take a detour away from the surface: close to it the free balls are small.
        const Vec3 away = start - mesh_.point_of(hint, start).point_m;
        const double size = away.norm();
        const Vec3 up = size > 0.0 ? Vec3(0.7 * way / size * away) : Vec3(Vec3::Zero());
        double at = 0.0;
        is_free = way_is_free(start, seen.distance_m, start + up, hint, at, allowed) &&
                  way_is_free(start + up, at, end + up, hint, at, allowed) &&
                  way_is_free(end + up, at, end, hint, there, allowed);
    }
    queries += allowed;
    if (is_free) put(i, there, hint);
    return is_free;
}

void ToolPoints::wake(const Pose& pose, std::uint32_t points, std::span<const std::uint32_t> kept,
                      std::uint32_t queries) noexcept {
    points = std::min(points, count_);
    const auto is_kept = [&](std::uint32_t i) {
        return std::find(kept.begin(), kept.end(), i) != kept.end();
    };
    std::uint32_t beyond = 0;  // awake points with an index of at least `points`
    for (std::uint32_t i = points; i < points_; ++i) {
        if (!is_known(i)) continue;
        if (i != root_ && !is_kept(i))
            sleep(i);
        else
            ++beyond;
    }
    root_counts_ = root_ < points || is_kept(root_);
    if (root_ >= std::max(points, points_)) ++beyond;
    // Kept points may have higher indices: extend the range that loops visit.
    points_ = points;
    for (const std::uint32_t i : kept) {
        if (i < count_ && is_known(i)) points_ = std::max(points_, i + 1);
    }
    if (awake_ >= points + beyond || awake_ == 0) {
        tried_all_ = true;
        return;
    }
    turn_levers(pose, count_);
    if (next_ >= points) next_ = 0;
    // At most one pass; points with sleeping parents cost nothing.
    for (std::uint32_t tried = 0; tried < points && queries > 0; ++tried) {
        if (!is_known(next_)) try_to_wake(next_, queries);
        if (++next_ == points) {
            next_ = 0;
            tried_all_ = true;
        }
    }
}

void ToolPoints::begin_move(const Pose& pose) noexcept {
    ++move_;
    // Single precision does not suffice far from the anchor: move the anchor.
    if ((pose.p_m - anchor_m_).squaredNorm() > 4.0 * reach_m_ * reach_m_) {
        const Eigen::Vector3f by = (pose.p_m - anchor_m_).cast<float>();
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (float& a : asked_[axis]) a -= by[static_cast<Eigen::Index>(axis)];
        anchor_m_ = pose.p_m;
    }
    hand_m_ = pose.p_m;
    const Eigen::Matrix3f turn = pose.q.toRotationMatrix().cast<float>();
    const Eigen::Vector3f from_anchor = (hand_m_ - anchor_m_).cast<float>();
    PointRooms job{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        job.local[axis] = local_[axis].data();
        job.asked[axis] = asked_[axis].data();
        job.lever[axis] = lever_[axis].data();
        job.hand[axis] = from_anchor[a];
        for (int column = 0; column < 3; ++column) job.turn[axis][column] = turn(a, column);
    }
    job.bound = bound_.data();
    job.room = room_.data();
    job.count = filled_up(std::max(points_, root_ + 1));
    job.taken =
        static_cast<float>(ball_m_ + 2e-7 * reach_m_) + kRounding * (static_cast<float>(3.0 * reach_m_));
    kernels_->rooms(job);
    if (!root_counts_) room_[root_] = 1e30F;
}

double ToolPoints::way_m(std::uint32_t i, const Vec3& v_m, const Vec3& w_rad) const noexcept {
    return (v_m + w_rad.cross(lever_m(i).cast<double>())).norm();
}

// Calls visit(i) for each point whose displacement v + w x lever may exceed `share` of its room, until it returns false.
// Almost always there is none in a block.
template <class Visit>
void ToolPoints::visit_beyond(const Vec3& v_m, const Vec3& w_rad, float share, Visit visit) const noexcept {
    const Eigen::Vector3f v = v_m.cast<float>(), w = w_rad.cast<float>();
    const PointsBeyond job{{lever_[0].data(), lever_[1].data(), lever_[2].data()},
                           room_.data(),
                           {v.x(), v.y(), v.z()},
                           {w.x(), w.y(), w.z()},
                           share * share};
    for (std::size_t begin = 0; begin < points_; begin += kPointBlock) {
        std::uint64_t over = kernels_->beyond(job, begin);
        if (points_ - begin < kPointBlock) over &= (std::uint64_t{1} << (points_ - begin)) - 1;
        for (; over != 0; over &= over - 1) {
            const std::size_t i = begin + static_cast<std::size_t>(std::countr_zero(over));
            if (!has_passed(i, v, w) && !visit(static_cast<std::uint32_t>(i))) return;
        }
    }
}

bool ToolPoints::has_passed(std::size_t i, const Eigen::Vector3f& v_m,
                            const Eigen::Vector3f& w_rad) const noexcept {
    const Passed& p = passed_[i];
    if (p.move != move_) return false;
    const Eigen::Vector3f lever(lever_[0][i], lever_[1][i], lever_[2][i]);
    return (v_m + w_rad.cross(lever) - p.displacement_m).squaredNorm() <= p.over_m * p.over_m;
}

std::size_t ToolPoints::beyond(const Vec3& v_m, const Vec3& w_rad,
                               std::span<std::uint32_t> out) const noexcept {
    std::size_t found = 0;
    visit_beyond(v_m, w_rad, 1.0F, [&](std::uint32_t i) {
        if (found < out.size()) out[found++] = i;
        return found < out.size();
    });
    return found;
}

double ToolPoints::share_in_room(const Vec3& v_m, const Vec3& w_rad) const noexcept {
    double share = 1.0;
    visit_beyond(v_m, w_rad, kNearlyBeyond, [&](std::uint32_t i) {
        const double way = way_m(i, v_m, w_rad), room = room_m(i);
        if (is_awake(i) && way * share > room) share = room / way;
        return true;
    });
    return share;
}

bool ToolPoints::recall(std::uint32_t i, double wanted_m) noexcept {
    if (brute_) return false;
    const double distance = known_.distance_m(place_m(i));
    if (distance - ball_m_ < wanted_m) return false;
    put(i, distance, SurfacePoint::kNone);
    room_[i] = static_cast<float>((distance - ball_m_) * (1.0 - 1e-6));
    return true;
}

void ToolPoints::ask(std::uint32_t i, double wanted_m) noexcept {
    const double at_most = kAtMost * wanted_m + ball_m_;
    double distance =
        brute_ ? all_.clearance_m(place_m(i), at_most) : mesh_.clearance_m(place_m(i), at_most, kVisits);
    // Nearer to a box than to what is in it.
    if (!brute_ && distance <= ball_m_) {
        const Seen seen = query(place_m(i), hint_[i]);
        hint_[i] = seen.triangle;
        distance = std::max(distance, seen.distance_m);
    }
    known_.remember(place_m(i), distance);
    // With large triangles, the bound from boxes can be worse than the known one.
    if (distance - ball_m_ <= room_m(i)) return;
    put(i, distance, SurfacePoint::kNone);
    room_[i] = static_cast<float>((distance - ball_m_) * (1.0 - 1e-6));
}

void ToolPoints::clears(std::uint32_t i, double distance_m) noexcept {
    if (distance_m - ball_m_ <= room_m(i)) return;
    put(i, distance_m, SurfacePoint::kNone);
    room_[i] = static_cast<float>((distance_m - ball_m_) * (1.0 - 1e-6));
}

void ToolPoints::passes(std::uint32_t i, const Vec3& displacement_m, double over_m) noexcept {
    passed_[i] = {displacement_m.cast<float>(), static_cast<float>(0.999 * over_m), move_};
}

void ToolPoints::saw(std::uint32_t i, double distance_m, double guarded_m) noexcept {
    put(i, distance_m, SurfacePoint::kNone);
    known_.remember(place_m(i), distance_m);
    room_[i] = static_cast<float>(std::max(guarded_m, distance_m - ball_m_));
}

}  // namespace tact
