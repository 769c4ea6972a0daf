#include "rt/force/surface/half_spaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace tact {
namespace {

using F4 [[gnu::vector_size(16)]] = float;
using I4 [[gnu::vector_size(16)]] = std::int32_t;
constexpr float kAlwaysKept = 1e30F;

// The point nearest to the goal on the planes n·x + s = 0 of at most three half-spaces: x = goal + sum of weight * n.
// False if the planes are nearly parallel or a weight is negative.
bool meet(const Vec3& goal_m, std::span<HalfSpaces::Active* const> planes, Vec3& move_m) noexcept {
    const auto lack = [&](std::size_t i) { return -(planes[i]->normal.dot(goal_m) + planes[i]->slack_m); };
    const auto normal = [&](std::size_t i) -> const Vec3& { return planes[i]->normal; };
    std::array<double, 3> weight{};
    if (planes.size() == 1) {
        weight[0] = lack(0);
    } else if (planes.size() == 2) {
        const double g = normal(0).dot(normal(1)), det = 1.0 - g * g;
        if (det < 1e-10) return false;
        weight[0] = (lack(0) - g * lack(1)) / det;
        weight[1] = (lack(1) - g * lack(0)) / det;
    } else {
        // The intersection of the three planes, then the weights by the dual basis.
        const Vec3 n12 = normal(1).cross(normal(2)), n20 = normal(2).cross(normal(0)),
                   n01 = normal(0).cross(normal(1));
        const double det = normal(0).dot(n12);
        if (std::abs(det) < 1e-8) return false;
        const Vec3 x = (lack(0) * n12 + lack(1) * n20 + lack(2) * n01) / det;  // from the goal
        weight = {x.dot(n12) / det, x.dot(n20) / det, x.dot(n01) / det};
    }
    move_m = goal_m;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (!(weight[i] >= 0.0)) return false;
        planes[i]->weight_m = weight[i];
        move_m += weight[i] * normal(i);
    }
    return true;
}

}  // namespace

bool HalfSpaces::add(std::uint32_t triangle, const TriangleQueries& query, std::size_t lane,
                     float near_slack_m, float facet_slack_m, bool facet_holds) noexcept {
    if (count_ == kMax) return false;
    const std::size_t i = count_++;
    // The search works in blocks of four: pad the block with half-spaces that every move satisfies.
    for (std::size_t k = i + 1; i % 4 == 0 && k < i + 4; ++k) {
        for (const Row r : {near_x, near_y, near_z, facet_x, facet_y, facet_z, facet_s}) row(r)[k] = 0.0F;
        row(near_s)[k] = kAlwaysKept;
    }
    row(near_x)[i] = query.away[0][lane];
    row(near_y)[i] = query.away[1][lane];
    row(near_z)[i] = query.away[2][lane];
    row(near_s)[i] = near_slack_m;
    const auto& facet = facet_holds ? query.facet : query.away;
    row(facet_x)[i] = facet[0][lane];
    row(facet_y)[i] = facet[1][lane];
    row(facet_z)[i] = facet[2][lane];
    row(facet_s)[i] = facet_holds ? facet_slack_m : near_slack_m;
    triangle_[i] = triangle;
    return true;
}

void HalfSpaces::allow_staying() noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        row(near_s)[i] = std::max(row(near_s)[i], 0.0F);
        row(facet_s)[i] = std::max(row(facet_s)[i], 0.0F);
    }
}

template <bool kNearestOnly>
std::size_t HalfSpaces::most_violated(const Vec3& move_m, double& value) const noexcept {
    const auto x = static_cast<float>(move_m.x()), y = static_cast<float>(move_m.y()),
               z = static_cast<float>(move_m.z());
    const auto kept = [&](auto load) {
        const auto near = load(near_x) * x + load(near_y) * y + load(near_z) * z + load(near_s);
        if constexpr (kNearestOnly) return near;
        const auto facet = load(facet_x) * x + load(facet_y) * y + load(facet_z) * z + load(facet_s);
        return near > facet ? near : facet;
    };
    // g++ does not vectorize a minimum with its index: four lanes by hand.
    F4 least4 = F4{} + 1e30F;
    I4 at4{};
    I4 here{0, 1, 2, 3};
    for (std::size_t i = 0; i < count_; i += 4, here += 4) {
        const F4 kept4 = kept([&](Row r) {
            F4 v;
            std::memcpy(&v, row(r) + i, sizeof v);
            return v;
        });
        const I4 less = kept4 < least4;
        least4 = less ? kept4 : least4;
        at4 = less ? here : at4;
    }
    float least = least4[0];
    auto at = static_cast<std::size_t>(at4[0]);
    for (int lane = 1; lane < 4; ++lane) {
        if (least4[lane] >= least) continue;
        least = least4[lane];
        at = static_cast<std::size_t>(at4[lane]);
    }
    value = static_cast<double>(least);
    return at;
}

// The half-space away from the nearest point bounds the distance from below.
std::size_t HalfSpaces::near_after(const Vec3& move_m, double slack_m,
                                   std::span<std::uint32_t> out) const noexcept {
    const auto x = static_cast<float>(move_m.x()), y = static_cast<float>(move_m.y()),
               z = static_cast<float>(move_m.z()), most = static_cast<float>(slack_m);
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; i += 4) {
        const auto load = [&](Row r) {
            F4 v;
            std::memcpy(&v, row(r) + i, sizeof v);
            return v;
        };
        const I4 near = load(near_x) * x + load(near_y) * y + load(near_z) * z + load(near_s) <= F4{} + most;
        if ((near[0] | near[1] | near[2] | near[3]) == 0) continue;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if (near[static_cast<int>(lane)] == 0) continue;
            if (count == out.size()) return count;
            out[count++] = triangle_[i + lane];
        }
    }
    return count;
}

HalfSpaces::Active HalfSpaces::half_space(std::size_t half_space, bool facet) const noexcept {
    const std::size_t first = facet ? facet_x : near_x;
    const auto value = [&](std::size_t i) {
        return static_cast<double>(row(static_cast<Row>(first + i))[half_space]);
    };
    Active active;
    active.normal = Vec3(value(0), value(1), value(2));
    active.slack_m = value(3);
    active.half_space = static_cast<std::uint32_t>(half_space);
    active.facet = facet;
    return active;
}

HalfSpaces::Active HalfSpaces::asked_least(std::size_t index, const Vec3& move_m,
                                           std::span<const Active> turned) const noexcept {
    for (const Active& t : turned) {
        if (t.half_space == index) return t;
    }
    const Active near = half_space(index, false), facet = half_space(index, true);
    return near.normal.dot(move_m) + near.slack_m >= facet.normal.dot(move_m) + facet.slack_m ? near : facet;
}

// The largest fraction of a move, at most 1, whose end satisfies every half-space.
double HalfSpaces::free_share(const Vec3& move_m) const noexcept {
    double share = 1.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const auto reach = [&](Row x, Row y, Row z, Row s) {
            const double along = static_cast<double>(row(x)[i]) * move_m.x() +
                                 static_cast<double>(row(y)[i]) * move_m.y() +
                                 static_cast<double>(row(z)[i]) * move_m.z();
            const double slack = std::max(static_cast<double>(row(s)[i]), 0.0);
            return along >= 0.0 ? 1.0 : slack / -along;
        };
        share = std::min(share, std::max(reach(near_x, near_y, near_z, near_s),
                                         reach(facet_x, facet_y, facet_z, facet_s)));
    }
    return share;
}

// If a triangle is active although its other half-space is satisfied, the search chose the wrong one of the two: it was
// less violated far from the surface, where the search starts. Switch to the other one while this comes nearer to
// the goal.
HalfSpaces::Solution HalfSpaces::solve(const Vec3& goal_m, double tolerance_m) const noexcept {
    std::array<Active, kTurnsMax> turned;
    std::size_t turns = 0;
    Solution best = solve_with(goal_m, tolerance_m, {});
    while (turns < kTurnsMax && best.exact) {
        const std::size_t before = turns;
        for (std::size_t i = 0; i < best.active_count && turns < kTurnsMax; ++i) {
            const Active& held = best.active[i];
            const Active other = half_space(held.half_space, !held.facet);
            if (other.normal.dot(best.move_m) + other.slack_m <= tolerance_m) continue;
            if (std::any_of(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turns),
                            [&](const Active& t) { return t.half_space == held.half_space; }))
                continue;
            turned[turns++] = other;
        }
        if (turns == before) break;
        const Solution next = solve_with(goal_m, tolerance_m, std::span(turned).first(turns));
        if (!next.exact || (next.move_m - goal_m).squaredNorm() >= (best.move_m - goal_m).squaredNorm())
            break;
        best = next;
    }
    return best;
}

bool HalfSpaces::activate(const Vec3& goal_m, double tolerance_m, const Active& added, Solution& s) noexcept {
    std::array<Active, 4> all;
    const std::size_t before = s.active_count;
    for (std::size_t i = 0; i < before; ++i) all[i] = s.active[i];
    all[before] = added;
    bool found = false;
    const auto attempt = [&](std::array<std::size_t, 3> chosen, std::size_t count) {
        if (found) return;
        std::array<Active*, 3> planes{};
        for (std::size_t i = 0; i < count; ++i) planes[i] = &all[chosen[i]];
        Vec3 move_m;
        if (!meet(goal_m, std::span<Active* const>(planes.data(), count), move_m)) return;
        for (std::size_t i = 0; i <= before; ++i) {
            if (all[i].normal.dot(move_m) + all[i].slack_m < -tolerance_m) return;
        }
        found = true;
        s.move_m = move_m;
        s.active_count = count;
        for (std::size_t i = 0; i < count; ++i) s.active[i] = *planes[i];
    };
    attempt({before, 0, 0}, 1);
    for (std::size_t i = 0; i < before; ++i) attempt({before, i, 0}, 2);
    for (std::size_t i = 0; i < before; ++i)
        for (std::size_t k = i + 1; k < before; ++k) attempt({before, i, k}, 3);
    return found;
}

HalfSpaces::Solution HalfSpaces::solve_nearest(const Vec3& goal_m, double tolerance_m) const noexcept {
    Solution s;
    s.move_m = goal_m;
    s.exact = count_ == 0;
    for (int round = 0; round < kRoundsMax && !s.exact; ++round) {
        double value = 0.0;
        const std::size_t worst = most_violated<true>(s.move_m, value);
        s.exact = value >= -tolerance_m;
        if (!s.exact && !activate(goal_m, tolerance_m, half_space(worst, false), s)) break;
    }
    return s;
}

HalfSpaces::Solution HalfSpaces::solve_with(const Vec3& goal_m, double tolerance_m,
                                            std::span<const Active> turned) const noexcept {
    Solution s;
    s.move_m = goal_m;
    if (count_ == 0) return s;
    for (int round = 0; round < kRoundsMax; ++round) {
        double value = 0.0;
        const std::size_t worst = most_violated<false>(s.move_m, value);
        if (value >= -tolerance_m) return s;
        if (!activate(goal_m, tolerance_m, asked_least(worst, s.move_m, turned), s)) break;
    }
    s.exact = false;
    s.move_m *= free_share(s.move_m);
    return s;
}

}  // namespace tact
