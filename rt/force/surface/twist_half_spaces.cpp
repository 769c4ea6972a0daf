#include "rt/force/surface/twist_half_spaces.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr std::size_t kSlackRow = 6, kRowsEach = 7;
// Relative square of the part of a normal outside the span of the active ones; below it, the normal is dependent.
constexpr double kIndependent = 1e-8;

}  // namespace

bool TwistHalfSpaces::add(std::uint32_t point, std::uint32_t triangle, const Eigen::Vector3f& lever,
                          const TriangleQueries& query, std::size_t lane, float near_slack_m,
                          float facet_slack_m, bool facet_holds) noexcept {
    if (count_ == kMax) return false;
    const std::size_t i = count_++;
    const auto put = [&](std::size_t first, const float(&n)[3][kLooks], float slack_m) {
        const Eigen::Vector3f normal(n[0][lane], n[1][lane], n[2][lane]);
        const Eigen::Vector3f turn = lever.cross(normal);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            row(first + axis)[i] = normal[static_cast<Eigen::Index>(axis)];
            row(first + 3 + axis)[i] = turn[static_cast<Eigen::Index>(axis)];
        }
        row(first + kSlackRow)[i] = slack_m;
    };
    put(0, query.away, near_slack_m);
    if (facet_holds)
        put(kRowsEach, query.facet, facet_slack_m);
    else
        put(kRowsEach, query.away, near_slack_m);
    triangle_[i] = triangle;
    point_[i] = point;
    return true;
}

void TwistHalfSpaces::allow_staying() noexcept {
    for (const std::size_t slack : {kSlackRow, kRowsEach + kSlackRow})
        for (std::size_t i = 0; i < count_; ++i) row(slack)[i] = std::max(row(slack)[i], 0.0F);
}

std::size_t TwistHalfSpaces::most_violated(const Vec6& move_m, float within_m, double& value) const noexcept {
    const Eigen::Matrix<float, 6, 1> y = move_m.cast<float>();
    float least = 1e30F;
    std::size_t at = 0;
    constexpr std::size_t kBlock = 64;
    std::array<float, kBlock> kept;
    for (std::size_t begin = 0; begin < count_; begin += kBlock) {
        const std::size_t n = std::min(kBlock, count_ - begin);
        const auto value_of = [&](std::size_t first, std::size_t i) {
            return row(first)[begin + i] * y[0] + row(first + 1)[begin + i] * y[1] +
                   row(first + 2)[begin + i] * y[2] + row(first + 3)[begin + i] * y[3] +
                   row(first + 4)[begin + i] * y[4] + row(first + 5)[begin + i] * y[5] +
                   row(first + kSlackRow)[begin + i];
        };
        for (std::size_t i = 0; i < n; ++i) kept[i] = value_of(0, i);
        for (std::size_t i = 0; i < n; ++i) {
            const float facet = value_of(kRowsEach, i);
            kept[i] = facet > kept[i] ? facet : kept[i];
            kept[i] = row(kSlackRow)[begin + i] <= within_m ? kept[i] : 1e30F;
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (kept[i] < least) {
                least = kept[i];
                at = begin + i;
            }
        }
    }
    value = static_cast<double>(least);
    return at;
}

TwistHalfSpaces::Active TwistHalfSpaces::half_space(std::size_t half_space, bool facet) const noexcept {
    const std::size_t first = facet ? kRowsEach : 0;
    Active active;
    for (std::size_t k = 0; k < 6; ++k)
        active.normal[static_cast<Eigen::Index>(k)] = static_cast<double>(row(first + k)[half_space]);
    active.slack_m = static_cast<double>(row(first + kSlackRow)[half_space]);
    active.half_space = static_cast<std::uint32_t>(half_space);
    active.facet = facet;
    return active;
}

TwistHalfSpaces::Active TwistHalfSpaces::asked_least(std::size_t index, const Vec6& move_m,
                                                     std::span<const Active> turned) const noexcept {
    for (const Active& t : turned) {
        if (t.half_space == index) return t;
    }
    const Active near = half_space(index, false), facet = half_space(index, true);
    return near.normal.dot(move_m) + near.slack_m >= facet.normal.dot(move_m) + facet.slack_m ? near : facet;
}

// Finds the optimum under the active half-spaces and a violated one, which becomes active. A step along z keeps the
// active ones satisfied and reduces the violation; the old weights shrink by r. A half-space whose weight reaches zero
// is removed.
bool TwistHalfSpaces::bring_in(const Active& wanted, Solution& s) noexcept {
    Active entering = wanted;
    entering.weight_m = 0.0;
    const double size = entering.normal.squaredNorm();
    for (int step = 0; step < 8; ++step) {
        // r = (N^T N)^-1 N^T n by Cholesky.
        const std::size_t q = s.active_count;
        std::array<std::array<double, 6>, 6> l;
        std::array<double, 6> r;
        bool regular = true;
        for (std::size_t i = 0; i < q; ++i) {
            for (std::size_t k = 0; k <= i; ++k) {
                double sum = s.active[i].normal.dot(s.active[k].normal);
                for (std::size_t m = 0; m < k; ++m) sum -= l[i][m] * l[k][m];
                if (i == k) {
                    regular &= sum > 0.0;
                    l[i][i] = std::sqrt(std::max(sum, 1e-300));
                } else {
                    l[i][k] = sum / l[k][k];
                }
            }
            double sum = s.active[i].normal.dot(entering.normal);
            for (std::size_t m = 0; m < i; ++m) sum -= l[i][m] * r[m];
            r[i] = sum / l[i][i];
        }
        if (!regular) return false;
        for (std::size_t i = q; i-- > 0;) {
            for (std::size_t m = i + 1; m < q; ++m) r[i] -= l[m][i] * r[m];
            r[i] /= l[i][i];
        }
        Vec6 z = entering.normal;
        for (std::size_t i = 0; i < q; ++i) z -= r[i] * s.active[i].normal;
        const double zz = z.squaredNorm();
        const bool moves = q < 6 && zz > kIndependent * size;
        const double lack = -(entering.normal.dot(s.move_m) + entering.slack_m);
        const double whole = moves ? std::max(lack, 0.0) / zz : 1e300;
        double part = 1e300;
        std::size_t leaves = 0;
        for (std::size_t i = 0; i < q; ++i) {
            if (r[i] > 1e-12 && s.active[i].weight_m / r[i] < part) {
                part = s.active[i].weight_m / r[i];
                leaves = i;
            }
        }
        const double t = std::min(whole, part);
        if (!(t < 1e300)) return false;
        for (std::size_t i = 0; i < q; ++i)
            s.active[i].weight_m = std::max(s.active[i].weight_m - t * r[i], 0.0);
        entering.weight_m += t;
        if (moves) s.move_m += t * z;
        if (whole <= part) {
            s.active[s.active_count++] = entering;
            return true;
        }
        for (std::size_t i = leaves; i + 1 < q; ++i) s.active[i] = s.active[i + 1];
        --s.active_count;
    }
    return false;
}

TwistHalfSpaces::Solution TwistHalfSpaces::fresh(const Vec6& goal_m) noexcept {
    Solution s;
    s.move_m = goal_m;
    return s;
}

void TwistHalfSpaces::solve_with(const Rules& rules, std::span<const Active> turned,
                                 Solution& s) const noexcept {
    for (int round = 0; round < kRoundsMax && count_ > 0; ++round) {
        double value = 0.0;
        const std::size_t worst = most_violated(s.move_m, rules.within_m, value);
        if (value >= -rules.tolerance_m) return;
        if (!bring_in(asked_least(worst, s.move_m, turned), s)) break;
    }
    if (count_ == 0) return;
    s.exact = false;
    s.move_m *= free_share(s.move_m, rules.within_m);
}

void TwistHalfSpaces::solve(const Vec6& goal_m, const Rules& rules, Solution& before) const noexcept {
    if (!before.exact) before = fresh(goal_m);
    solve_with(rules, {}, before);
}

// As in HalfSpaces::solve.
void TwistHalfSpaces::turn(const Vec6& goal_m, const Rules& rules, Solution& best) const noexcept {
    std::array<Active, kTurnsMax> turned;
    std::size_t turns = 0;
    while (turns < kTurnsMax && best.exact) {
        const std::size_t before = turns;
        for (std::size_t i = 0; i < best.active_count && turns < kTurnsMax; ++i) {
            const Active& held = best.active[i];
            const Active other = half_space(held.half_space, !held.facet);
            if (other.normal.dot(best.move_m) + other.slack_m <= rules.tolerance_m) continue;
            if (std::any_of(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turns),
                            [&](const Active& t) { return t.half_space == held.half_space; }))
                continue;
            turned[turns++] = other;
        }
        if (turns == before) break;
        Solution next = fresh(goal_m);
        solve_with(rules, std::span(turned).first(turns), next);
        if (!next.exact || (next.move_m - goal_m).squaredNorm() >= (best.move_m - goal_m).squaredNorm())
            break;
        best = next;
    }
}

// The largest fraction of a move, at most 1, whose end satisfies every half-space.
double TwistHalfSpaces::free_share(const Vec6& move_m, float within_m) const noexcept {
    double share = 1.0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (row(kSlackRow)[i] > within_m) continue;
        const auto reach = [&](bool facet) {
            const Active h = half_space(i, facet);
            const double along = h.normal.dot(move_m);
            return along >= 0.0 ? 1.0 : std::max(h.slack_m, 0.0) / -along;
        };
        share = std::min(share, std::max(reach(false), reach(true)));
    }
    return share;
}

}  // namespace tact
