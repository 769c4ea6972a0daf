// Half-space constraints that keep the proxy off a surface during one move, and the point nearest to a goal inside them.
//
// Sound    Let a ball of radius r about c be free of a triangle. Any half-space n·x + s >= 0 (x relative to c, n unit) of
//          collision-free centre positions suffices for that triangle. Each triangle has two: away from its nearest
//          point (the distance is a convex function of x with slope n), and above its plane. If the end of a move is
//          inside at least one of the two for every triangle, the whole move is free, because its start is inside
//          both. No sweep is needed.
// Solve    finds the point nearest to the goal by an active set of at most three half-spaces. Each round adds the less
//          violated half-space of the most violated triangle, until none is violated. The distance to the goal grows
//          in each round, so it terminates; kRoundsMax is a safeguard. Then active triangles whose other half-space
//          is satisfied are switched to that one, as long as this brings the solution nearer to the goal.
// Unit     metres of the model; single precision relative to the proxy.
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

class HalfSpaces {
public:
    static constexpr std::size_t kMax = 8192;
    static constexpr int kRoundsMax = 48;
    static constexpr std::size_t kTurnsMax = 8;

    struct Active {
        Vec3 normal = Vec3::Zero();
        double slack_m = 0.0;   // allowed displacement of the proxy against the normal
        double weight_m = 0.0;  // >= 0; solution = goal + sum of weight_m * normal
        std::uint32_t half_space = 0;
        bool facet = false;  // false: nearest point, true: plane
    };
    struct Solution {
        Vec3 move_m = Vec3::Zero();  // from the proxy
        std::array<Active, 3> active;
        std::size_t active_count = 0;
        bool exact =
            true;  // false: rounding or kRoundsMax ended the search; the move was shortened until free
    };

    HalfSpaces() : float_(std::size_t{8} * kRow), triangle_(kMax) {}

    void clear() noexcept TACT_RT { count_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept TACT_RT { return count_; }
    [[nodiscard]] std::uint32_t triangle(std::size_t half_space) const noexcept TACT_RT {
        return triangle_[half_space];
    }
    // Triangles that may be nearer than their rest plus slack_m after a move. Returns their number, at most out.size().
    std::size_t near_after(const Vec3& move_m, double slack_m,
                           std::span<std::uint32_t> out) const noexcept TACT_RT;
    // A negative near_slack_m pushes the proxy out. False: no room.
    bool add(std::uint32_t triangle, const TriangleQueries& query, std::size_t lane, float near_slack_m,
             float facet_slack_m, bool facet_holds) noexcept TACT_RT;
    // Sets negative slacks to zero, so that every half-space permits a zero move.
    void allow_staying() noexcept TACT_RT;
    // As solve(), with the half-spaces away from the nearest points only: what the triangles allow near the proxy.
    [[nodiscard]] Solution solve_nearest(const Vec3& goal_m, double tolerance_m) const noexcept TACT_RT;
    // goal_m: relative to the proxy. tolerance_m: violation up to which a half-space counts as satisfied.
    // The solution under the active half-spaces and one more, which has to be active: the only subset with non-negative
    // weights that satisfies the others. False: none, by rounding; `solution` is unchanged.
    [[nodiscard]] static bool activate(const Vec3& goal_m, double tolerance_m, const Active& added,
                                       Solution& solution) noexcept TACT_RT;
    [[nodiscard]] Solution solve(const Vec3& goal_m, double tolerance_m) const noexcept TACT_RT;

private:
    // One extra cache line per row, so that the rows of one half-space do not map to the same cache set.
    static constexpr std::size_t kRow = kMax + 16;
    enum Row : std::size_t { near_x, near_y, near_z, near_s, facet_x, facet_y, facet_z, facet_s };
    [[nodiscard]] float* row(Row r) noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] const float* row(Row r) const noexcept { return float_.data() + r * kRow; }
    template <bool kNearestOnly>
    [[nodiscard]] std::size_t most_violated(const Vec3& move_m, double& value) const noexcept TACT_RT;
    [[nodiscard]] Active half_space(std::size_t half_space, bool facet) const noexcept TACT_RT;
    [[nodiscard]] Active asked_least(std::size_t half_space, const Vec3& move_m,
                                     std::span<const Active> turned) const noexcept TACT_RT;
    [[nodiscard]] Solution solve_with(const Vec3& goal_m, double tolerance_m,
                                      std::span<const Active> turned) const noexcept TACT_RT;
    [[nodiscard]] double free_share(const Vec3& move_m) const noexcept TACT_RT;

    std::vector<float> float_;
    std::vector<std::uint32_t> triangle_;
    std::size_t count_ = 0;
};

}  // namespace tact
