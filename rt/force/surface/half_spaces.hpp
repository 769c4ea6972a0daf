// What keeps a proxy off a surface for one move: half-spaces, and the nearest place to a goal inside them.
//
// Sound    Let a ball of radius r about c be free of a triangle. A half-space n·x + s >= 0 (x from c, n unit)
//          in which all places of the centre are free suffices against that triangle, and so does any other
//          one. Each triangle brings two: away from its nearest point (its distance is a convex function of x,
//          and n its slope), and over its own plane. A move whose end is, for every triangle, inside one of its
//          two is free all along, as its beginning is inside both. No sweep is needed.
// Solve    the point nearest to the goal under the half-spaces found necessary: an active set of at most
//          three, to which the most violated triangle is added, by the one of its two that asks less, until
//          none is violated. The distance to the goal rises with each, so it ends; kRoundsMax is the net. Then
//          guards that hold by the wrong one of their two are turned round, as long as that leads nearer.
// Unit     metres of the model; single precision about the proxy.
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

class HalfSpaces {
public:
    static constexpr std::size_t kMax = 8192;
    static constexpr int kRoundsMax = 48;
    static constexpr std::size_t kTurnsMax = 8;

    struct Active {
        Vec3 normal = Vec3::Zero();
        double slack_m = 0.0;   // how far the proxy may go against the normal
        double weight_m = 0.0;  // >= 0; the sum of weight times normal leads from the goal to the solution
        std::uint32_t half_space = 0;
        bool facet = false;  // which of its two
    };
    struct Solution {
        Vec3 move_m = Vec3::Zero();  // from the proxy
        std::array<Active, 3> active;
        std::size_t active_count = 0;
        bool exact = true;  // false: numbers or rounds ran out, and the move was shortened until it is free
    };

    HalfSpaces() : float_(std::size_t{8} * kRow), triangle_(kMax) {}

    void clear() noexcept TACT_RT { count_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept TACT_RT { return count_; }
    [[nodiscard]] std::uint32_t triangle(std::size_t half_space) const noexcept TACT_RT {
        return triangle_[half_space];
    }
    // near_slack_m may be negative: then the proxy is to be pushed out. False: there is no room.
    bool add(std::uint32_t triangle, const TriangleQueries& query, std::size_t lane, float near_slack_m,
             float facet_slack_m, bool facet_holds) noexcept TACT_RT;
    // Nothing is pushed out any more: staying is allowed by every guard.
    void allow_staying() noexcept TACT_RT;
    // goal_m: from the proxy. tolerance_m: of a guard that counts as kept.
    [[nodiscard]] Solution solve(const Vec3& goal_m, double tolerance_m) const noexcept TACT_RT;

private:
    // A cache line more, so that the rows of one guard do not fall on the same lines of the cache.
    static constexpr std::size_t kRow = kMax + 16;
    enum Row : std::size_t { near_x, near_y, near_z, near_s, facet_x, facet_y, facet_z, facet_s };
    [[nodiscard]] float* row(Row r) noexcept { return float_.data() + r * kRow; }
    [[nodiscard]] const float* row(Row r) const noexcept { return float_.data() + r * kRow; }
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
