// A surface with the full mesh's detail around the tool and coarse detail elsewhere, for the servo's contact.
//
// Halves    slow_update() refines the surface along the predicted path of the tool and, once it has full detail there,
//           builds the near surface. around() gives the servo the latest near surface that contains a ball.
// Radius    of full detail around a box along that path: the tool's radius, the search radius of a step, and a width
//           that depends on the fidelity.
// Cost      predicted time of a slow update: a time per triangle around the tool, learnt from updates that built a near
//           surface, times the number of triangles at a fidelity.
// Outside   around() returns false and the servo searches the tree over the full mesh: same force, cost of that tree.
//           Coarse triangles never contribute to the force.
// Unit      metres of the model.  Thread  constructed anywhere; slow_update() on one thread, around() on the servo's. No
//           allocation after construction.
#pragma once

#include <array>
#include <atomic>

#include "ipc/scene/mesh/refinement.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"
#include "rt/force/surface/near_surface.hpp"
#include "rt/force/surface/triple_buffer.hpp"

namespace tact {

struct AdaptiveSettings {
    double least_m = 0.0, most_m = 0.0;       // radius of full detail, at fidelity 0 and 1
    std::uint32_t near_nodes_max = 1U << 15;  // of the near surface's tree: about 300,000 triangles
    static constexpr double kLookAheadS = 0.012;
    double look_ahead_s = kLookAheadS;
};

class AdaptiveSurface {
public:
    // The memory behind mesh and forest must outlive the object.
    AdaptiveSurface(const SurfaceMesh& full, const VertexForest& forest, const AdaptiveSettings& settings);

    // Slow thread, at least 200 times per second.
    RefineStep slow_update(const Vec3& tool_m, const Vec3& velocity_m_s, float fidelity,
                           const FilterForm& form = {}) noexcept;
    // Servo. True if the current near surface, or a newer one, contains the ball; near() then returns that surface.
    [[nodiscard]] bool around(const Vec3& centre_m, double radius_m) noexcept TACT_RT;
    [[nodiscard]] const NearSurface& near() const noexcept TACT_RT { return surface_.same(); }

    [[nodiscard]] double radius_m(float fidelity) const noexcept TACT_RT;
    // Expected number of triangles around the tool at a fidelity, from the mesh's mean density.
    [[nodiscard]] double predicted_triangles(float fidelity) const noexcept TACT_RT;
    // Predicted duration of a slow update that builds, s; 0: none measured yet. Any thread.
    [[nodiscard]] double predicted_s(float fidelity) const noexcept TACT_RT {
        return static_cast<double>(s_per_triangle_.load(std::memory_order_relaxed)) *
               predicted_triangles(fidelity);
    }
    // Bound on the distance between the active surface and the full one; visits all active vertices. On the thread of
    // slow_update().
    [[nodiscard]] float deviation_m() const noexcept { return refinement_.deviation_m(); }
    [[nodiscard]] std::size_t memory_bytes() const { return refinement_.memory_bytes(); }

private:
    void set_filter(float fidelity, const FilterForm& form) noexcept;
    [[nodiscard]] bool still_holds(const Vec3& tool_m, const Vec3& velocity_m_s) const noexcept;

    const SurfaceMesh full_;  // views
    const VertexForest forest_;
    AdaptiveSettings settings_;
    double density_ = 0.0;  // triangles per square metre
    float fidelity_ = 1.0F;
    FilterForm form_;
    std::atomic<float> s_per_triangle_{0.0F};
    Refinement refinement_;
    std::uint64_t built_ = 0;  // number of near surfaces built; below: the box of the last one
    std::array<float, 3> built_low_m_{}, built_high_m_{};
    TripleBuffer<NearSurface> surface_;
};

}  // namespace tact
