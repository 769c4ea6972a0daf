// How far the points of a tool are from a surface at the least, asked only where that is used up.
//
// Bound     the distance of a point when it was asked, less the way that it has gone since: so far from the
//           surface a point costs nothing. One that is asked again costs one query of the tree, bounded.
// Awake     a point counts once it is known to be on the side of the surface where the tool is: by the bound of
//           its parent (the point nearest to it before it), or by a way from there to it, over the surface,
//           along which balls free of the surface touch each other. A point that is on the other side (the
//           knob rose where something pokes between the points) sleeps: it is not felt, and is tried again from
//           time to time. No point that counts is ever on another side.
// Work      counted in queries; every function has a limit of them.
// Unit      metres of the model. Single precision about an anchor near the tool.
// Thread    made anywhere (it allocates); then servo, TACT_RT.
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

namespace tact {

class ToolPoints {
public:
    static constexpr std::uint32_t kVisits = 192;  // of the tree, for one query: some microseconds

    // The bytes behind `mesh` must outlive the object. ball_m: of each point.
    // brute: ask() looks at all triangles.
    ToolPoints(const SurfaceMesh& mesh, const TouchTool& tool, double ball_m, bool brute = false);

    [[nodiscard]] std::uint32_t size() const noexcept TACT_RT { return count_; }
    [[nodiscard]] double gyration_m() const noexcept TACT_RT { return gyration_m_; }
    [[nodiscard]] double reach_m() const noexcept TACT_RT { return reach_m_; }
    [[nodiscard]] double cover_m(std::uint32_t points) const noexcept TACT_RT {
        return static_cast<double>(cover_m_[points - 1]);
    }

    // All sleep but one. Returns where the hand's point has to be for the whole tool to be free: where it is, or
    // farther away from the surface, outside if that is closed. Where there is no room for that, where it is
    // or beside it; then points that are in the surface sleep.
    Vec3 seat(const Pose& pose) noexcept TACT_RT;
    // Those behind the first `points` sleep if they are not among `kept`, the others wake as far as the queries
    // go; what is left waits.
    void wake(const Pose& pose, std::uint32_t points, std::span<const std::uint32_t> kept,
              std::uint32_t queries) noexcept TACT_RT;
    // Every one of the first `points` was tried since the tool was seated.
    [[nodiscard]] bool tried_all() const noexcept TACT_RT { return tried_all_; }
    [[nodiscard]] std::uint32_t awake() const noexcept TACT_RT { return awake_; }

    // Levers and rooms for moves from this pose.
    void begin_move(const Pose& pose) noexcept TACT_RT;
    // Awake points that v + w x lever takes farther than their room; as many as fit.
    std::size_t beyond(const Vec3& v_m, const Vec3& w_rad,
                       std::span<std::uint32_t> out) const noexcept TACT_RT;
    // The largest share of the move, at most 1, that leaves every point in its room.
    [[nodiscard]] double share_in_room(const Vec3& v_m, const Vec3& w_rad) const noexcept TACT_RT;
    [[nodiscard]] Vec3 place_m(std::uint32_t i) const noexcept TACT_RT;
    [[nodiscard]] Eigen::Vector3f lever_m(std::uint32_t i) const noexcept TACT_RT {
        return {lever_[0][i], lever_[1][i], lever_[2][i]};
    }
    [[nodiscard]] double way_m(std::uint32_t i, const Vec3& v_m, const Vec3& w_rad) const noexcept TACT_RT;
    [[nodiscard]] double room_m(std::uint32_t i) const noexcept TACT_RT {
        return static_cast<double>(room_[i]);
    }
    // The distance when it was asked last.
    [[nodiscard]] double asked_m(std::uint32_t i) const noexcept TACT_RT {
        return static_cast<double>(bound_[i]);
    }
    // A query: the room may be larger than was known, and than wanted_m.
    void ask(std::uint32_t i, double wanted_m) noexcept TACT_RT;
    // What was seen there: nothing is nearer than distance_m. Within guarded_m guards hold the ball off, so
    // that it may move that far.
    void saw(std::uint32_t i, double distance_m, double guarded_m) noexcept TACT_RT;
    [[nodiscard]] bool is_awake(std::uint32_t i) const noexcept TACT_RT {
        return bound_[i] >= 0.0F && (i != root_ || root_counts_);
    }

private:
    struct Seen {
        double distance_m;  // nothing is nearer
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
    void turn_levers(const Pose& pose) noexcept TACT_RT;
    [[nodiscard]] double bound_now_m(std::uint32_t i) const noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    AllTriangles all_;
    bool brute_;
    double ball_m_, gyration_m_ = 0.0, reach_m_ = 0.0;
    std::uint32_t count_;
    std::vector<std::uint32_t> parent_, hint_;
    std::vector<float> cover_m_;
    // Rows, filled up to a multiple of four: as in the tool; levers of the pose; where it was asked, from the
    // anchor.
    std::vector<float> local_[3], lever_[3], asked_[3];
    std::vector<float> bound_;  // distance where it was asked; below 0: asleep
    std::vector<float> room_;   // of the centre, before a move leaves what is known
    Vec3 hand_m_ = Vec3::Zero(), anchor_m_ = Vec3::Zero();
    std::uint32_t points_ = 0, awake_ = 0, next_ = 0;
    std::uint32_t root_ = 0;  // known before all others; counts where it is among the first
    bool tried_all_ = false, root_counts_ = true;
};

}  // namespace tact
