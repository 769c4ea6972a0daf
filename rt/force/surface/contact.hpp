// The proxy (god-object) of a point or spherical tool: a ball that follows the tool as far as the surface allows.
//
// Model     The proxy is the collision-free position of the ball's centre nearest to the goal, reached by moves that are
//           free along their whole length (half_spaces.hpp). A point is a ball of a few micrometres. Both sides of
//           every triangle are solid, so open surfaces and sheets without thickness work from the side of the proxy.
// Rest      The centre rests at radius_m over the inside of a triangle, at radius_m - margin_m over an edge or corner.
//           Were both equal, a ball resting on one facet could not leave it: the next facet's edge touches it already.
// Friction  Coulomb at the proxy: the touched triangles bear the pull up to a rest along the surface. The proxy stays if
//           this rest is at most the coefficient times the sum of their weights; otherwise it follows by the excess.
// Work      Triangles are collected from the tree in a ball wider than needed and kept while the proxy is inside. A move
//           queries the triangles within its reach, judged by each triangle's last distance and the path since. A
//           step has at most moves_max moves. If too many triangles are within reach, the move is shortened.
// Glide     In one step the proxy moves at most 1.5 times as far as the goal, plus lag_m. Where it leaves a hollow or
//           a sheet ends, it slides to the new position over several steps, so neither force nor work has a peak.
// Settled   only by proof (rest_proof.hpp): a true position of rest is at most a margin away.
// Lag       A step that runs out of moves or time leaves the proxy at a free position nearer to the goal and reports
//           `lagging`; the next step continues from there. The proxy cannot jam.
// Easy      A step on one facet, clear of all other triangles, is computed in closed form (easy_step.hpp).
// Unit      metres of the model.  Thread  constructed anywhere (allocates); then servo, TACT_RT.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/knob.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/triangle_query.hpp"
#include "rt/force/surface/all_triangles.hpp"
#include "rt/force/surface/easy_step.hpp"
#include "rt/force/surface/half_spaces.hpp"
#include "rt/force/surface/rest_proof.hpp"

namespace tact {

struct ContactSettings {
    double radius_m = 0.0;  // of the ball, > 0
    double margin_m = 0.0;  // > 0, less than the radius
    double friction = 0.0;  // coefficient
    double lag_m = 0.0;     // see Glide, > 0
    bool brute = false;     // query every triangle in every step, without the tree
};

enum class ContactState : std::uint8_t {
    settled,  // at the free position nearest to the goal
    gliding,  // moving, limited by the step's maximum displacement; or at rest without proof
    lagging,  // moving; moves or time ran out
};

struct Contact {
    Vec3 proxy_m = Vec3::Zero();
    // Active constraints: goal + sum of weight_m * normal is the frictionless proxy. The heaviest three.
    std::array<ContactPlane, 3> plane;
    std::uint32_t planes = 0;  // 0: free
    std::uint32_t moves = 0;
    std::uint32_t triangles = 0;  // queried
    Vec3 lift_m = Vec3::Zero();   // sum of weight_m * normal of all active constraints
    Vec3 rub_m =
        Vec3::Zero();  // goal + lift + rub = proxy: held by friction or, unless settled, not yet moved
    ContactState state = ContactState::settled;
    bool late = false;  // ended by the deadline
    // Position of the proxy after each move but the last; valid until the next step.
    std::span<const Vec3> after_m;
};

class SurfaceContact {
public:
    // A ball at rest on a plane is below it by its rounding, a part of the margin. It must not catch the edge of the next
    // triangle of that plane.
    static constexpr double kSunkMargins = 0.1;
    // Shorter moves are rounding noise; the proxy stays at rest.
    static constexpr double kRestingMargins = 0.02;
    static constexpr std::uint32_t kMovesMost = 24;  // of a step
    static constexpr std::size_t kLeavesMax = 4096;
    // A step starts no further move after this many queries, about 100 us.
    static constexpr std::uint32_t kTrianglesMost = 8192;

    // The memory behind `mesh` must outlive the object.
    SurfaceContact(const SurfaceMesh& mesh, const ContactSettings& settings);

    [[nodiscard]] const SurfaceMesh& mesh() const noexcept { return mesh_; }
    [[nodiscard]] const ContactSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] const Vec3& proxy_m() const noexcept TACT_RT { return proxy_m_; }
    [[nodiscard]] const Vec3& goal_m() const noexcept TACT_RT { return goal_m_; }  // of the last step
    // Search radius about the current proxy of a step towards the goal.
    [[nodiscard]] double looks_m(const Vec3& goal_m) const noexcept TACT_RT;
    // Searches this mesh's tree from now on. It must contain the same triangles, at least within looks_m() of the
    // proxy, and its memory must stay valid until the next use().
    void use(const SurfaceMesh& mesh) noexcept TACT_RT;
    // Puts the proxy at the goal or, if that is inside a closed surface, at the nearest position outside.
    void seat(const Vec3& goal_m) noexcept TACT_RT;
    // The coefficient for the next steps (stick_slip.hpp).
    void set_friction(double friction) noexcept TACT_RT { settings_.friction = friction; }
    // The last step moved the proxy by more than rounding.
    [[nodiscard]] bool moved() const noexcept TACT_RT {
        return moved_m_ > kRestingMargins * settings_.margin_m;
    }
    Contact follow(const Vec3& goal_m, std::uint32_t moves_max,
                   const Deadline& deadline = {}) noexcept TACT_RT;

private:
    static constexpr double kCollectedMoves = 1.25;  // radius of the collected ball, in moves
    static constexpr double kBoundSlack = 1e-5;      // relative rounding of distances in single precision

    bool collect(double& reach_m) noexcept TACT_RT;
    bool find(double radius_m) noexcept TACT_RT;
    void query(double& reach_m, double most_m, std::uint32_t& triangles) noexcept TACT_RT;
    bool half_space(std::uint32_t triangle, const TriangleQueries& seen, std::size_t lane) noexcept TACT_RT;
    bool step_easily(const Vec3& goal_m, double allowed_m, Contact& contact) noexcept TACT_RT;
    bool prove(const HalfSpaces::Solution& bearing, Vec3 moved_m, double reach_m) noexcept TACT_RT;
    void settle(const Vec3& begin_m, Contact& contact) noexcept TACT_RT;
    void note_clear(const Contact& contact, const Vec3& begin_m) noexcept TACT_RT;
    void list_proof(Contact& contact) const noexcept TACT_RT;
    [[nodiscard]] Vec3 slide() const noexcept TACT_RT;
    [[nodiscard]] HalfSpaces::Solution held_back(const HalfSpaces::Solution& free, const Vec3& goal_m,
                                                 double tolerance_m) const noexcept TACT_RT;
    [[nodiscard]] bool inside(const Vec3& point_m, const SurfacePoint& nearest) noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    AllTriangles all_;  // for brute
    ContactSettings settings_;
    HalfSpaces half_spaces_;
    RestProof proof_;
    EasyStep easy_;
    bool touches_ = false;  // at the end of the last step
    bool still_ = false;    // the goal hardly moved in this step
    const QueryKernel* kernel_;
    std::vector<std::uint32_t> leaf_;  // scratch
    // The collected triangles. The distance of each is at least its bound minus the path since they were collected.
    std::vector<std::uint32_t> triangle_;
    std::vector<float> bound_m_;
    std::size_t collected_ = 0;
    std::vector<std::uint32_t> slot_, number_;  // scratch: triangles in reach, by slot and by index
    Vec3 collected_at_m_ = Vec3::Zero();
    const SurfaceNode* full_tree_;
    bool whole_ = true;          // searches the tree of all triangles
    double widen_ = 1.0;         // of the collected ball, where triangles are few
    double collected_m_ = -1.0;  // allowed distance of the ball from there; < 0: nothing collected
    double way_m_ = 0.0;         // path length since the collection
    Vec3 proxy_m_ = Vec3::Zero(), goal_m_ = Vec3::Zero();
    double moved_m_ = 0.0;  // displacement in the last step
    std::array<Vec3, kMovesMost> after_m_;
};

}  // namespace tact
