// A surface that is as fine as its full mesh around the tool and coarse elsewhere, for the servo's contact.
//
// Halves    slow_update() moves the cut on and, where it is in full detail around the path that the tool is about to take, builds
//           the surface there; around() gives the servo what was built last, where it holds what is asked for.
// Radius    within it, of a box along that path, all is as in the full mesh: the tool's own, what a step may look
//           at, and a width that the fidelity chooses.
// Cost      of a turn of slow_update(): a rate a triangle around the tool, learnt from the turns that built, times how many
//           a fidelity brings.
// Outside   around() gives nothing, and the servo asks the tree over the full mesh: the same force, at the
//           price of that tree. Coarse triangles are never felt.
// Unit      metres of the model.  Thread  made anywhere; slow_update() one thread, around() the servo's. No allocation
//           after the constructor.
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
    std::uint32_t near_nodes_max = 1U << 15;  // of the tree around the tool: some 300,000 triangles
    static constexpr double kLookAheadS = 0.012;
    double look_ahead_s = kLookAheadS;
};

class AdaptiveSurface {
public:
    // The bytes behind mesh and forest outlive it.
    AdaptiveSurface(const SurfaceMesh& full, const VertexForest& forest, const AdaptiveSettings& settings);

    // Slow thread, 200 times a second or more.
    RefineStep slow_update(const Vec3& tool_m, const Vec3& velocity_m_s, float fidelity,
                           const FilterForm& form = {}) noexcept;
    // Servo. Whether a ball lies in what was built, the one of before or a newer one; then near() is it.
    [[nodiscard]] bool around(const Vec3& centre_m, double radius_m) noexcept TACT_RT;
    [[nodiscard]] const NearSurface& near() const noexcept TACT_RT { return surface_.same(); }

    [[nodiscard]] double radius_m(float fidelity) const noexcept TACT_RT;
    // Triangles around the tool at a fidelity, at the mesh's mean density.
    [[nodiscard]] double predicted_triangles(float fidelity) const noexcept TACT_RT;
    // What a turn that builds should take at a fidelity, by those before; 0: there was none yet. Any thread.
    [[nodiscard]] double predicted_s(float fidelity) const noexcept TACT_RT {
        return static_cast<double>(s_per_triangle_.load(std::memory_order_relaxed)) *
               predicted_triangles(fidelity);
    }
    // Of slow_update()'s thread. How far the active surface is from the full one at the most; it looks at all that is
    // active.
    [[nodiscard]] float deviation_m() const noexcept { return refinement_.deviation_m(); }
    [[nodiscard]] std::size_t memory_bytes() const { return refinement_.memory_bytes(); }

private:
    void set_filter(float fidelity, const FilterForm& form) noexcept;
    [[nodiscard]] bool still_holds(const Vec3& tool_m, const Vec3& velocity_m_s) const noexcept;

    const SurfaceMesh full_;  // views
    const VertexForest forest_;
    AdaptiveSettings settings_;
    double density_ = 0.0;  // triangles a square metre
    float fidelity_ = 1.0F;
    FilterForm form_;
    std::atomic<float> s_per_triangle_{0.0F};
    Refinement refinement_;
    std::uint64_t built_ = 0;  // how many; the box of the last
    std::array<float, 3> built_low_m_{}, built_high_m_{};
    TripleBuffer<NearSurface> surface_;
};

}  // namespace tact
