// Half-space constraints on the twist of a rigid body that keep it off a surface during one move, and the twist nearest to
// a goal inside them.
//
// Twist    y = (v, g w): displacement v of the hand point, rotation vector w about it in radians, radius of gyration g of
//          the body. So y is in metres, and its length is the metric for "nearest". A point of the body at lever l
//          from the hand point moves by v + w x l, to first order in w.
// Sound    as in half_spaces.hpp: each triangle near a ball has two half-spaces for the ball's displacement, away from
//          the nearest point and above the plane; the end of a move must be inside one of the two. A half-space
//          n·(v + w x l) + s >= 0 constrains the twist with the normal (n, l x n / g).
// Solve    dual active-set method (Goldfarb, Idnani 1983) with at most six active half-spaces. Each round adds the less
//          violated half-space of the most violated triangle. It resumes after half-spaces were added. Then active
//          triangles whose other half-space is satisfied are switched to that one, as in half_spaces.hpp.
// Weights  y = goal + sum of weight * normal; weight times stiffness is a contact force.
// Unit     metres of the model; half-spaces in single precision.
// Thread   constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/triangle_query.hpp"

namespace tact {

class TwistHalfSpaces {
public:
    static constexpr std::size_t kMax = 4096;
    static constexpr int kRoundsMax = 64;
    static constexpr std::size_t kTurnsMax = 8;

    struct Active {
        Vec6 normal = Vec6::Zero();
        double slack_m = 0.0;  // allowed displacement of the contact against the normal
        double weight_m = 0.0;
        std::uint32_t half_space = 0;
        bool facet = false;
    };
    struct Solution {
        Vec6 move_m = Vec6::Zero();
        std::array<Active, 6> active;
        std::size_t active_count = 0;
        bool exact =
            true;  // false: rounding or kRoundsMax ended the search; the move is free, but may not be nearest
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
    // lever: from the hand point, in radii of gyration. False: no room.
    bool add(std::uint32_t point, std::uint32_t triangle, const Eigen::Vector3f& lever,
             const TriangleQueries& query, std::size_t lane, float near_slack_m, float facet_slack_m,
             bool facet_holds) noexcept TACT_RT;
    // Sets negative slacks to zero, so that every half-space permits a zero move.
    void allow_staying() noexcept TACT_RT;

    // Which half-spaces count, and when: tolerance_m: violation up to which one is satisfied. within_m: triangles whose distance
    // leaves more slack than this are left out.
    struct Rules {
        double tolerance_m = 0.0;
        float within_m = 1e30F;
    };
    // before: solution for the same goal and fewer half-spaces, or fresh().
    [[nodiscard]] static Solution fresh(const Vec6& goal_m) noexcept TACT_RT;
    void solve(const Vec6& goal_m, const Rules& rules, Solution& before) const noexcept TACT_RT;
    // How far the normals of an active plane and of its nearest point are apart, per unit; 0 for a nearest point.
    [[nodiscard]] double turned_by(const Active& active) const noexcept TACT_RT {
        return active.facet ? (active.normal - half_space(active.half_space, false).normal).norm() : 0.0;
    }
    // Switches active triangles whose other half-space is satisfied to that one.
    void turn(const Vec6& goal_m, const Rules& rules, Solution& best) const noexcept TACT_RT;

private:
    // One extra cache line per row, so that the rows of one half-space do not map to the same cache set.
    static constexpr std::size_t kRow = kMax + 16;
    // Two groups of 7 rows (nearest points, planes): three for displacement, three for rotation, slack.
    [[nodiscard]] float* row(std::size_t r) noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] const float* row(std::size_t r) const noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] std::size_t most_violated(const Vec6& move_m, float within_m,
                                            double& value) const noexcept TACT_RT;
    [[nodiscard]] Active half_space(std::size_t half_space, bool facet) const noexcept TACT_RT;
    [[nodiscard]] Active asked_least(std::size_t half_space, const Vec6& move_m,
                                     std::span<const Active> turned) const noexcept TACT_RT;
    static bool bring_in(const Active& wanted, Solution& s) noexcept TACT_RT;
    void solve_with(const Rules& rules, std::span<const Active> turned, Solution& s) const noexcept TACT_RT;
    [[nodiscard]] double free_share(const Vec6& move_m, float within_m) const noexcept TACT_RT;

    std::vector<float> float_;
    std::vector<std::uint32_t> triangle_, point_;
    std::size_t count_ = 0;
};

}  // namespace tact
