// Lower bounds on the distances of a tool's points from a surface, renewed only when used up.
//
// Bound     the distance at the last query minus the displacement since. Points far from the surface cost nothing; a
//           renewal costs one bounded query of the tree.
//           Before that, the places known are looked up (known_places.hpp): where one point of the tool was, others soon come.
// Awake     A point is awake (in use) once it is known to be on the tool's side of the surface: by the bound of its
//           parent (the nearest point before it in the order), or by a path from the parent along which free balls
//           overlap. A point on the other side (the knob rose while the surface was between the points) sleeps: it has
//           no effect and is retried from time to time. No awake point is ever on the other side.
// Work      counted in queries; every function has a limit.
// Unit      metres of the model; single precision relative to an anchor near the tool.
// Thread    constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "rt/force/surface/all_triangles.hpp"
#include "rt/force/surface/known_places.hpp"
#include "rt/force/surface/point_rows.hpp"

namespace tact {

class ToolPoints {
public:
    static constexpr std::uint32_t kVisits = 192;  // tree nodes per query: a few microseconds

    // The memory behind `mesh` must outlive the object. ball_m: radius at each point. brute: ask() uses all triangles.
    ToolPoints(const SurfaceMesh& mesh, const TouchTool& tool, double ball_m, bool brute = false);

    [[nodiscard]] std::uint32_t size() const noexcept TACT_RT { return count_; }
    [[nodiscard]] double gyration_m() const noexcept TACT_RT { return gyration_m_; }
    [[nodiscard]] double reach_m() const noexcept TACT_RT { return reach_m_; }
    [[nodiscard]] double cover_m(std::uint32_t points) const noexcept TACT_RT {
        return static_cast<double>(cover_m_[points - 1]);
    }

    // Puts all points but one to sleep. Returns a position of the hand point at which the whole tool is free: the given
    // one, or one farther from the surface (outside, if closed). Without such a position, returns one at or near the
    // given one; points inside the surface then stay asleep.
    Vec3 seat(const Pose& pose) noexcept TACT_RT;
    // Puts points beyond the first `points` to sleep unless they are in `kept`, and wakes the others within the limit of
    // queries; the remaining ones wait for the next call.
    void wake(const Pose& pose, std::uint32_t points, std::span<const std::uint32_t> kept,
              std::uint32_t queries) noexcept TACT_RT;
    // True if each of the first `points` was tried since the tool was seated.
    [[nodiscard]] bool tried_all() const noexcept TACT_RT { return tried_all_; }
    [[nodiscard]] std::uint32_t awake() const noexcept TACT_RT { return awake_; }

    // Computes levers and rooms (free displacements) of the points in use for moves from this pose.
    void begin_move(const Pose& pose) noexcept TACT_RT;
    // Lists awake points whose displacement v + w x lever exceeds their room; as many as fit into `out`.
    std::size_t beyond(const Vec3& v_m, const Vec3& w_rad,
                       std::span<std::uint32_t> out) const noexcept TACT_RT;
    // The largest fraction of the move, at most 1, that keeps every point in its room.
    [[nodiscard]] double share_in_room(const Vec3& v_m, const Vec3& w_rad) const noexcept TACT_RT;
    [[nodiscard]] Vec3 place_m(std::uint32_t i) const noexcept TACT_RT;
    [[nodiscard]] Eigen::Vector3f lever_m(std::uint32_t i) const noexcept TACT_RT {
        return {lever_[0][i], lever_[1][i], lever_[2][i]};
    }
    [[nodiscard]] double way_m(std::uint32_t i, const Vec3& v_m, const Vec3& w_rad) const noexcept TACT_RT;
    [[nodiscard]] double room_m(std::uint32_t i) const noexcept TACT_RT {
        return static_cast<double>(room_[i]);
    }
    // The distance at the last query.
    [[nodiscard]] double asked_m(std::uint32_t i) const noexcept TACT_RT {
        return static_cast<double>(bound_[i]);
    }
    // Renews the bound of a point by what is remembered of places near it. True: its room is at least wanted_m.
    bool recall(std::uint32_t i, double wanted_m) noexcept TACT_RT;
    // Renews the bound of a point by a query; the room may become larger than wanted_m.
    void ask(std::uint32_t i, double wanted_m) noexcept TACT_RT;
    // Sets the result of a triangle query: nothing is nearer than distance_m. Within guarded_m half-spaces keep the ball
    // off the surface, so it may move that far.
    void saw(std::uint32_t i, double distance_m, double guarded_m) noexcept TACT_RT;
    // Nothing is nearer than distance_m: renews the bound if that is more than is known.
    void clears(std::uint32_t i, double distance_m) noexcept TACT_RT;
    // In this move, the point may go along displacement_m, or any other that ends no farther than over_m from its end.
    void passes(std::uint32_t i, const Vec3& displacement_m, double over_m) noexcept TACT_RT;
    [[nodiscard]] bool is_awake(std::uint32_t i) const noexcept TACT_RT {
        return bound_[i] >= 0.0F && (i != root_ || root_counts_);
    }

private:
    struct Seen {
        double distance_m;  // lower bound
        std::uint32_t triangle;
    };
    bool seat_freely(const Pose& pose, Vec3& hand_m) noexcept TACT_RT;
    void seat_one(Pose pose, Vec3& hand_m) noexcept TACT_RT;
    [[nodiscard]] bool is_known(std::uint32_t i) const noexcept { return bound_[i] >= 0.0F; }
    [[nodiscard]] Seen query(const Vec3& place_m, std::uint32_t hint) const noexcept TACT_RT;
    [[nodiscard]] bool way_is_free(const Vec3& from_m, double free_m, const Vec3& to_m, std::uint32_t& hint,
                                   double& free_there_m, std::uint32_t& queries) const noexcept TACT_RT;
    bool try_to_wake(std::uint32_t i, std::uint32_t& queries) noexcept TACT_RT;
    void put(std::uint32_t i, double distance_m, std::uint32_t hint) noexcept TACT_RT;
    void sleep(std::uint32_t i) noexcept TACT_RT;
    void turn_levers(const Pose& pose, std::uint32_t points) noexcept TACT_RT;  // of the first points
    template <class Visit>
    void visit_beyond(const Vec3& v_m, const Vec3& w_rad, float share, Visit visit) const noexcept TACT_RT;
    [[nodiscard]] bool has_passed(std::size_t i, const Eigen::Vector3f& v_m,
                                  const Eigen::Vector3f& w_rad) const noexcept TACT_RT;
    [[nodiscard]] double bound_now_m(std::uint32_t i) const noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    AllTriangles all_;
    bool brute_;
    double ball_m_, gyration_m_ = 0.0, reach_m_ = 0.0;
    std::uint32_t count_;
    std::vector<std::uint32_t> parent_, hint_;
    std::vector<float> cover_m_;
    // Rows, padded to a multiple of kPointBlock: points in the tool frame; levers of the pose; positions at the last query,
    // relative to the anchor.
    std::vector<float> local_[3], lever_[3], asked_[3];
    std::vector<float> bound_;  // distance at the last query; below 0: asleep
    std::vector<float> room_;   // displacement of the centre known to be free
    KnownPlaces known_;
    struct Passed {
        Eigen::Vector3f displacement_m = Eigen::Vector3f::Zero();
        float over_m = 0.0F;
        std::uint64_t move = 0;
    };
    std::vector<Passed> passed_;
    std::uint64_t move_ = 0;
    const PointKernels* kernels_;
    Vec3 hand_m_ = Vec3::Zero(), anchor_m_ = Vec3::Zero();
    std::uint32_t points_ = 0, awake_ = 0, next_ = 0;
    std::uint32_t root_ = 0;  // the first awake point; in use only if among the first points or kept
    bool tried_all_ = false, root_counts_ = true;
};

}  // namespace tact
