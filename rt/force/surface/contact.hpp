// A ball that follows a point as far as a surface lets it: the proxy of a point or spherical tool.
//
// Model     The centre of the ball stays where the ball is free of every triangle, and goes to the place there
//           that is nearest to the goal, along moves that are free all along (guards.hpp). A point is a ball of
//           a few micrometres. Both sides of every triangle hold it off, so an open surface is felt on the side
//           where the proxy is, and a sheet without thickness holds.
// Rest      Over the inside of a triangle the centre rests at radius_m, over an edge or a corner at radius_m
//           less margin_m: were both the same, a ball at rest on one facet could not leave it, as the next
//           one's edge already touches it.
// Friction  With p the depth of the goal behind the frictionless place x, the proxy stays where it is nearer to
//           x than friction * p along the surface, else it follows until it is that near. So the force stays
//           in the cone of half angle atan(friction).
// Work      Triangles are collected from the tree in a ball that is wider than needed and kept while the proxy is
//           inside. A move looks at those that can be in its reach, by the distance that each had when it was
//           last looked at and the way since; at most moves_max moves a step. Where triangles are so dense that
//           they do not fit, the move is made shorter instead.
// Glide     In one step the proxy gets at most 1.5 times as far as the goal did and glide_m more. Where it
//           leaves a hollow, or a sheet ends, it slides to its new place within some steps instead of leaping,
//           so the force has no steps there and a step has not more work than others.
// Lag       a step that used up its moves or its time leaves the proxy where it is free, nearer to the goal
//           than before, and says so; the next step goes on from there. It cannot jam.
// Unit      metres of the model.  Thread  made anywhere (it allocates); then servo, TACT_RT.
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
#include "rt/force/surface/half_spaces.hpp"

namespace tact {

struct ContactSettings {
    double radius_m = 0.0;  // of the ball, > 0
    double margin_m = 0.0;  // > 0, less than the radius
    double friction = 0.0;  // coefficient
    double lag_m = 0.0;     // see Glide, > 0
    bool brute = false;     // every triangle is looked at in every step, without the tree
};

enum class ContactState : std::uint8_t {
    settled,  // as near to the goal as it can be
    gliding,  // on its way, and as far as one step may take it
    lagging,  // the moves or the time were used up before
};

struct ContactPlane {
    Vec3 normal = Vec3::Zero();  // towards the proxy, unit
    double weight_m = 0.0;       // see Contact
    std::uint32_t triangle = 0;
};

struct Contact {
    Vec3 proxy_m = Vec3::Zero();
    // Where the goal would be felt without friction: the sum of weight times normal leads from the goal there.
    std::array<ContactPlane, 3> plane;
    std::uint32_t planes = 0;  // 0: free
    std::uint32_t moves = 0;
    std::uint32_t triangles = 0;  // looked at
    ContactState state = ContactState::settled;
    bool late = false;  // the deadline ended it
    // Where the proxy was after each move but the last.
    std::span<const Vec3> after_m;
};

class SurfaceContact {
public:
    static constexpr std::uint32_t kMovesMost = 24;  // of a step
    static constexpr std::size_t kLeavesMax = 4096;
    // A step begins no further move once it has looked at so many: some 100 us.
    static constexpr std::uint32_t kTrianglesMost = 8192;

    // The bytes behind `mesh` must outlive the object.
    SurfaceContact(const SurfaceMesh& mesh, const ContactSettings& settings);

    [[nodiscard]] const SurfaceMesh& mesh() const noexcept { return mesh_; }
    [[nodiscard]] const ContactSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] const Vec3& proxy_m() const noexcept TACT_RT { return proxy_m_; }
    [[nodiscard]] const Vec3& goal_m() const noexcept TACT_RT { return goal_m_; }  // of the last step
    // How far from the proxy as it is a step towards a goal may look.
    [[nodiscard]] double looks_m(const Vec3& goal_m) const noexcept TACT_RT;
    // From now on the same triangles are found in this one's tree, at least those that the next step may look at. Its bytes
    // stay until another one is used.
    void use(const SurfaceMesh& mesh) noexcept TACT_RT;
    // The proxy is at the goal, or where that is inside a closed surface, outside at the nearest place.
    void seat(const Vec3& goal_m) noexcept TACT_RT;
    Contact follow(const Vec3& goal_m, std::uint32_t moves_max,
                   const Deadline& deadline = {}) noexcept TACT_RT;

private:
    bool collect(double& reach_m) noexcept TACT_RT;
    bool find(double radius_m) noexcept TACT_RT;
    void query(double& reach_m, double most_m, std::uint32_t& triangles) noexcept TACT_RT;
    bool half_space(std::uint32_t triangle, const TriangleQueries& seen, std::size_t lane) noexcept TACT_RT;
    [[nodiscard]] bool rests(const HalfSpaces::Solution& solution) const noexcept TACT_RT;
    [[nodiscard]] HalfSpaces::Solution held_back(const HalfSpaces::Solution& free, const Vec3& goal_m,
                                                 double tolerance_m) const noexcept TACT_RT;
    [[nodiscard]] bool inside(const Vec3& point_m, const SurfacePoint& nearest) noexcept TACT_RT;

    SurfaceMesh mesh_;  // a view
    AllTriangles all_;  // of brute
    ContactSettings settings_;
    HalfSpaces half_spaces_;
    const QueryKernel* kernel_;
    std::vector<std::uint32_t> leaf_;  // scratch
    // The collected triangles. None is nearer than its bound less the way since they were collected.
    std::vector<std::uint32_t> triangle_;
    std::vector<float> bound_m_;
    std::size_t collected_ = 0;
    std::vector<std::uint32_t> slot_,
        number_;  // scratch: those in reach, by their place and by their triangle
    Vec3 collected_at_m_ = Vec3::Zero();
    double collected_m_ = -1.0;  // how far the ball may go from there; < 0: nothing is collected
    double way_m_ = 0.0;         // since then
    Vec3 proxy_m_ = Vec3::Zero(), goal_m_ = Vec3::Zero();
    double moved_m_ = 0.0;  // by the last step
    std::array<Vec3, kMovesMost> after_m_;
};

}  // namespace tact
