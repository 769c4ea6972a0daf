// What keeps a rigid body off a surface for one move: half-spaces of its twist, and the twist nearest to a goal
// inside them.
//
// Twist    y = (v, g w): v the way of the hand's point, w the rotation about it in radians, g the body's radius
//          of gyration; so y is in metres, and its length is the metric in which "nearest" is meant. A place of
//          the body at the lever l from the hand's point moves by v + w x l, to first order in w.
// Sound    as guards.hpp: each triangle near a ball brings two half-spaces of the ball's way, away from the
//          nearest point and over the plane; the end of a move is to be inside one of the two. A half-space
//          n·(v + w x l) + s >= 0 is one of the twist, with the normal (n, l x n / g).
// Solve    dual active set (Goldfarb, Idnani 1983) of at most six, to which the most violated guard is added, by
//          the one of its two that asks less. It goes on where it was when guards were added since. Then guards
//          that hold by the wrong one of their two are turned round, as long as that leads nearer.
// Weights  y = goal + sum of weight times normal: times stiffness they are the forces of the touched places.
// Unit     metres of the model; guards in single precision.
// Thread   made anywhere (it allocates); then servo, TACT_RT.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/triangle_query.hpp"

namespace tact {

using Vec6 = Eigen::Matrix<double, 6, 1>;

class TwistHalfSpaces {
public:
    static constexpr std::size_t kMax = 4096;
    static constexpr int kRoundsMax = 64;
    static constexpr std::size_t kTurnsMax = 8;

    struct Active {
        Vec6 normal = Vec6::Zero();
        double slack_m = 0.0;  // how far the place may go against the normal
        double weight_m = 0.0;
        std::uint32_t half_space = 0;
        bool facet = false;
    };
    struct Solution {
        Vec6 move_m = Vec6::Zero();
        std::array<Active, 6> active;
        std::size_t active_count = 0;
        bool exact = true;  // false: numbers or rounds ran out; the move is free, but maybe not the nearest
    };

    TwistHalfSpaces() : float_(std::size_t{14} * kRow), triangle_(kMax), point_(kMax) {}

    void clear() noexcept TACT_RT { count_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept TACT_RT { return count_; }
    [[nodiscard]] std::uint32_t triangle(std::size_t half_space) const noexcept TACT_RT {
        return triangle_[half_space];
    }
    [[nodiscard]] std::uint32_t point(std::size_t half_space) const noexcept TACT_RT {
        return point_[half_space];
    }
    // lever: from the hand's point, in radii of gyration. False: there is no room.
    bool add(std::uint32_t point, std::uint32_t triangle, const Eigen::Vector3f& lever,
             const TriangleQueries& query, std::size_t lane, float near_slack_m, float facet_slack_m,
             bool facet_holds) noexcept TACT_RT;
    // Nothing is pushed out any more: staying is allowed by every guard.
    void allow_staying() noexcept TACT_RT;

    // tolerance_m: of a guard that counts as kept. before: of the same goal and fewer guards, or fresh.
    [[nodiscard]] static Solution fresh(const Vec6& goal_m) noexcept TACT_RT;
    void solve(const Vec6& goal_m, double tolerance_m, Solution& before) const noexcept TACT_RT;
    // Turns what holds by the wrong one of its two.
    void turn(const Vec6& goal_m, double tolerance_m, Solution& best) const noexcept TACT_RT;

private:
    // A cache line more, so that the rows of one guard do not fall on the same lines of the cache.
    static constexpr std::size_t kRow = kMax + 16;
    // Rows of 7: three of the way, three of the turn, slack; first of the nearest points, then of the planes.
    [[nodiscard]] float* row(std::size_t r) noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] const float* row(std::size_t r) const noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] std::size_t most_violated(const Vec6& move_m, double& value) const noexcept TACT_RT;
    [[nodiscard]] Active half_space(std::size_t half_space, bool facet) const noexcept TACT_RT;
    [[nodiscard]] Active asked_least(std::size_t half_space, const Vec6& move_m,
                                     std::span<const Active> turned) const noexcept TACT_RT;
    static bool bring_in(const Active& wanted, Solution& s) noexcept TACT_RT;
    void solve_with(double tolerance_m, std::span<const Active> turned, Solution& s) const noexcept TACT_RT;
    [[nodiscard]] double free_share(const Vec6& move_m) const noexcept TACT_RT;

    std::vector<float> float_;
    std::vector<std::uint32_t> triangle_, point_;
    std::size_t count_ = 0;
};

}  // namespace tact
