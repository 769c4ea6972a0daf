// A rigid body that follows the hand in six degrees of freedom as far as a surface lets it: the proxy of a
// tool given as a mesh.
//
// Model     Balls at the tool's points (touch_tool.hpp) stay free of every triangle. The proxy is the pose that
//           is nearest to the goal, in the metric of twist_guards.hpp, along moves that are free all along. So
//           k times the way from the goal to it is what the touched places push with, and k times the square of
//           the radius of gyration times the turn is the torque of those forces about the hand's point.
// Turns     A move turns by so little that the way of no point is off its tangent by more than margin_m.
// Lazy      A move asks for a pose with the guards of the few points that held the last one; points that the
//           answer takes farther than they are known to be free are looked at and bring their guards, until
//           none is left. The others cost an addition.
// Friction  as contact.hpp, in the same metric: the cone is one of the whole wrench.
// Glide     as contact.hpp: in one step at the most 1.5 times as far as the goal, and glide_m more.
// Lag       a step that used up its moves, queries or time leaves the proxy where it is free, nearer to the goal
//           than before, and says so. No point goes where it is not known to be free; it cannot jam.
// Unit      metres of the model.  Thread  made anywhere (it allocates); then servo, TACT_RT.
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
        false;  // every triangle is looked at in every step, without the tree; not to seat or wake points
};

// A place of the tool that holds it.
struct TouchedPlace {
    Vec3 lever_m = Vec3::Zero();  // from the hand's point
    Vec3 normal = Vec3::Zero();   // towards the tool, unit
    double weight_m = 0.0;        // times stiffness: the force there
    std::uint32_t point = 0, triangle = 0;
};

struct ToolTouch {
    Pose T_model_proxy;
    std::array<TouchedPlace, 6> place;
    std::uint32_t places = 0;                        // 0: free
    std::uint32_t moves = 0, looked = 0, asked = 0;  // points looked at, and queries of the tree besides
    ContactState state = ContactState::settled;
    bool late = false;
    bool adaptive = false;  // all triangles were found on the adaptive surface
};

class ToolContact {
public:
    static constexpr std::uint32_t kLooksMost = 320;    // of a step
    static constexpr std::uint32_t kQueriesMost = 320;  // of a step, those that wake points not counted
    static constexpr std::uint32_t kWakeQueries = 24;   // of a step
    static constexpr std::uint32_t kSeatQueries = 96;   // of a step, until every point was tried once

    ToolContact(const SurfaceMesh& mesh, const TouchTool& tool, const ToolContactSettings& settings);

    [[nodiscard]] const ToolContactSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] const ToolPoints& points() const noexcept TACT_RT { return points_; }
    [[nodiscard]] const Pose& proxy() const noexcept TACT_RT { return proxy_; }
    [[nodiscard]] const SurfaceMesh& mesh() const noexcept TACT_RT { return mesh_; }
    [[nodiscard]] const Pose& goal() const noexcept TACT_RT { return goal_; }
    // From a pose to another: (way, radius of gyration times turn).
    [[nodiscard]] Vec6 way_m(const Pose& from, const Pose& to) const noexcept TACT_RT;

    // The proxy begins where it is free all around and comes to the goal, or to rest on the surface, by steps of a
    // kSeatSteps-th of the tool's reach; until then it is seating(), and nothing should be felt.
    static constexpr double kSeatSteps = 30.0;
    static constexpr int kSeatingMost = 400;
    void seat(const Pose& goal) noexcept TACT_RT;
    [[nodiscard]] bool seating() const noexcept TACT_RT { return seating_ > 0; }
    // near: of an adaptive surface, until this returns; may be null.
    ToolTouch follow(const Pose& goal, std::uint32_t points, std::uint32_t moves_max,
                     const Deadline& deadline = {}, const NearSurface* near = nullptr) noexcept TACT_RT;

private:
    struct Move {
        Vec6 y = Vec6::Zero();
        bool cut = false;     // by what a move or a step may do at the most
        bool short_ = false;  // by what is not known to be free
        bool full = false;    // there was no room for all guards
    };
    // As long as left_m, as longest_m_, and as there is room for its guards.
    Move find_move(const Vec6& request, double left_m, ToolTouch& touch,
                   const Deadline& deadline) noexcept TACT_RT;
    Move find_move_within(const Vec6& request, double left_m, ToolTouch& touch,
                          const Deadline& deadline) noexcept TACT_RT;
    bool query(std::uint32_t point, double reach_m, ToolTouch& touch) noexcept TACT_RT;
    [[nodiscard]] Vec6 held_back(const TwistHalfSpaces::Solution& free, const Vec6& goal_m,
                                 double tolerance_m) const noexcept TACT_RT;
    void list_places(const TwistHalfSpaces::Solution& solution, ToolTouch& touch) const noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    ToolContactSettings settings_;
    ToolPoints points_;
    TwistHalfSpaces half_spaces_;
    const QueryKernel* kernel_;
    ToolLists lists_;
    std::vector<std::uint32_t> beyond_;
    std::array<std::uint32_t, 6> held_{};  // points that held the last move
    std::size_t held_count_ = 0;
    double turn_max_rad_;
    double last_move_m_ = 0.0;
    double longest_m_ = 0.0;  // of the next move: what a longer one could touch would be looked at in vain
    int seating_ = 0;         // steps that are left for it
    Pose proxy_, goal_;
};

}  // namespace tact
