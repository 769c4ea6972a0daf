// The proxy of a mesh tool: a rigid body that follows the hand in six degrees of freedom as far as the surface allows.
//
// Model     Balls at the tool's points (touch_tool.hpp) stay free of every triangle. The proxy is the free pose nearest
//           to the goal in the metric of twist_half_spaces.hpp, reached by moves that are free along their whole
//           length. So k times the displacement from goal to proxy is the sum of the contact forces, and k times the
//           squared radius of gyration times the rotation is their torque about the hand point.
// Turns     A move rotates so little that no point leaves its tangent by more than margin_m.
// Lazy      A move starts with the half-spaces of the few points active in the last move. Points that the solution moves
//           beyond their known free distance are queried and add their half-spaces, until none is left. All other
//           points cost one addition.
// Friction  as in contact.hpp, in the same metric: one cone for the whole wrench, of the triangles that are touched now.
// Way       a move is at most 1.5 times the goal's displacement, plus lag_m; a step has as many as it needs. So the proxy is
//           at rest although a tool of many points leaves one hollow for the next in a jump; the force follows at its own pace
//           (contact_force.hpp). Only a seating proxy glides, as in contact.hpp.
// Lag       A step that runs out of moves, queries or time leaves the proxy at a free pose nearer to the goal and reports
//           `lagging`. No point leaves its known free region, so the proxy cannot jam.
// Unit      metres of the model.  Thread  constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/knob.hpp"
#include "rt/force/surface/contact.hpp"
#include "rt/force/surface/tool_lists.hpp"
#include "rt/force/surface/tool_points.hpp"
#include "rt/force/surface/twist_half_spaces.hpp"

namespace tact {

struct ToolContactSettings {
    double ball_m = 0.0;    // > 0
    double margin_m = 0.0;  // > 0, less than the ball's radius
    double friction = 0.0;
    double lag_m = 0.0;  // > 0
    bool brute =
        false;  // query every triangle in every step, without the tree; not for seating or waking points
};

// An active contact of the tool.
struct TouchedPlace {
    Vec3 lever_m = Vec3::Zero();  // from the hand point
    Vec3 normal = Vec3::Zero();   // towards the tool, unit
    double weight_m = 0.0;        // times stiffness: the contact force
    std::uint32_t point = 0, triangle = 0;
};

struct ToolTouch {
    Pose T_model_proxy;
    std::array<TouchedPlace, 6> place;
    std::uint32_t places = 0;                        // 0: free
    std::uint32_t moves = 0, looked = 0, asked = 0;  // moves, triangle queries, distance queries
    ContactState state = ContactState::settled;
    bool late = false;
    bool adaptive = false;  // all triangles were found on the adaptive surface
};

class ToolContact {
public:
    // Limits per step.
    static constexpr std::uint32_t kQueriesMost = 448;  // of triangles, and of distances apart from waking
    static constexpr std::uint32_t kWakeQueries = 24;   // queries that wake points
    static constexpr std::uint32_t kSeatQueries = 96;   // the same, until every point was tried once

    ToolContact(const SurfaceMesh& mesh, const TouchTool& tool, const ToolContactSettings& settings);

    [[nodiscard]] const ToolContactSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] const ToolPoints& points() const noexcept TACT_RT { return points_; }
    [[nodiscard]] const Pose& proxy() const noexcept TACT_RT { return proxy_; }
    [[nodiscard]] const SurfaceMesh& mesh() const noexcept TACT_RT { return mesh_; }
    [[nodiscard]] const Pose& goal() const noexcept TACT_RT { return goal_; }
    // Difference of two poses: (displacement, radius of gyration times rotation vector).
    [[nodiscard]] Vec6 way_m(const Pose& from, const Pose& to) const noexcept TACT_RT;

    // Puts the proxy at a pose that is free all around. It then approaches the goal or the surface by 1 / kSeatSteps of
    // the tool's reach per step; until it arrives, seating() is true and the force should be off.
    static constexpr double kSeatSteps = 30.0;
    static constexpr int kSeatingMost = 400;
    void seat(const Pose& goal) noexcept TACT_RT;
    [[nodiscard]] bool seating() const noexcept TACT_RT { return seating_ > 0; }
    // The coefficient for the next steps (stick_slip.hpp).
    void set_friction(double friction) noexcept TACT_RT { settings_.friction = friction; }
    // The last step moved the proxy by more than rounding.
    [[nodiscard]] bool moved() const noexcept TACT_RT {
        return last_move_m_ > SurfaceContact::kRestingMargins * settings_.margin_m;
    }
    // Of one step; queries: of triangles, and as many of distances.
    struct Limits {
        std::uint32_t points = 1, moves = 1, queries = kQueriesMost;
    };
    // near: of an adaptive surface, valid during the call; may be null.
    ToolTouch follow(const Pose& goal, const Limits& limits, const Deadline& deadline = {},
                     const NearSurface* near = nullptr) noexcept TACT_RT;

private:
    struct Move {
        Vec6 y = Vec6::Zero();
        bool cut = false;     // shortened to the maximum of a move or step
        bool short_ = false;  // shortened to the region known to be free
        bool full = false;    // no room for all half-spaces
        bool exact = true;    // the half-spaces were solved
    };
    // Finds a move no longer than left_m and longest_m_ that has room for its half-spaces.
    Move find_move(const Vec6& request, double left_m, ToolTouch& touch,
                   const Deadline& deadline) noexcept TACT_RT;
    Move find_move_within(const Vec6& request, double left_m, ToolTouch& touch,
                          const Deadline& deadline) noexcept TACT_RT;
    bool query(std::uint32_t point, double reach_m, ToolTouch& touch) noexcept TACT_RT;
    bool is_known_free(std::uint32_t point, const Vec3& v_m, const Vec3& w_rad,
                       double way_m) noexcept TACT_RT;
    [[nodiscard]] Vec6 held_back(const TwistHalfSpaces::Solution& touched, const Vec6& goal_m,
                                 const TwistHalfSpaces::Rules& rules,
                                 TwistHalfSpaces::Solution& held) const noexcept TACT_RT;
    void hold(const TwistHalfSpaces::Solution& bears, const TwistHalfSpaces::Solution& ends) noexcept TACT_RT;
    [[nodiscard]] bool bears_as_touched(const TwistHalfSpaces::Solution& touched) const noexcept TACT_RT;
    void list_places(const TwistHalfSpaces::Solution& solution, ToolTouch& touch) const noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    ToolContactSettings settings_;
    ToolPoints points_;
    TwistHalfSpaces half_spaces_;
    const QueryKernel* kernel_;
    ToolLists lists_;
    std::vector<std::uint32_t> beyond_;
    std::array<std::uint32_t, 12> held_{};  // points active in the last move
    std::size_t held_count_ = 0;
    double turn_max_rad_;
    double sunk_m_ = 0.0;  // of the points queried in this move, beyond a margin
    double last_move_m_ = 0.0;
    double longest_m_ = 0.0;  // maximum length of the next move; a longer one would only waste queries
    int seating_ = 0;         // steps left for seating
    std::uint32_t queries_most_ = kQueriesMost;  // of this step
    Pose proxy_, goal_;
};

}  // namespace tact
