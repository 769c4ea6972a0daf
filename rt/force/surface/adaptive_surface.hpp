// A surface that is as fine as its full mesh around the tool and coarse elsewhere, for the servo's contact.
//
// Halves    tend() moves the cut on and builds the surface around the path that the tool is about to take;
//           around() gives the servo what was built last, where it holds what is asked for.
// Radius    within it, of a box along that path, all is as in the full mesh: the tool's own, what a step may look
//           at, and a width that the fidelity chooses.
// Outside   around() gives nothing, and the servo asks the tree over the full mesh: the same force, at the
//           price of that tree. Coarse triangles are never felt.
// Unit      metres of the model.  Thread  made anywhere; tend() one thread, around() the servo's. No allocation
//           after the constructor.
#pragma once

#include <array>

#include "ipc/assets/surface_mesh.hpp"
#include "ipc/assets/vertex_forest.hpp"
#include "rt/force/surface/near_surface.hpp"
#include "rt/force/surface/refinement.hpp"

namespace tact {

struct AdaptiveSettings {
    double least_m = 0.0, most_m = 0.0;  // radius of full detail, at fidelity 0 and 1
    std::uint32_t near_max = 1U << 16;   // triangles around the tool
    double look_ahead_s = 0.012;
};

class AdaptiveSurface {
public:
    // The bytes behind mesh and forest outlive it.
    AdaptiveSurface(const SurfaceMesh& full, const VertexForest& forest, const AdaptiveSettings& settings);

    // Slow thread, 200 times a second or more.
    RefineStep tend(const Vec3& tool_m, const Vec3& velocity_m_s, float fidelity) noexcept;
    // Servo. Whether a ball lies in what was built, the one of before or a newer one; then mesh() is it.
    [[nodiscard]] bool around(const Vec3& centre_m, double radius_m) noexcept TACT_RT;
    [[nodiscard]] SurfaceMesh mesh() const noexcept TACT_RT { return surface_.same().mesh(); }
    // Rises with every other mesh().
    [[nodiscard]] std::uint64_t version() const noexcept TACT_RT { return surface_.same().step(); }

    [[nodiscard]] double radius_m(float fidelity) const noexcept;
    // Triangles around the tool at a fidelity, at the mesh's mean density.
    [[nodiscard]] double predicted_triangles(float fidelity) const noexcept;
    [[nodiscard]] std::size_t memory_bytes() const { return refinement_.memory_bytes(); }

private:
    void set_radius(float fidelity) noexcept;
    [[nodiscard]] bool still_holds(const Vec3& tool_m, const Vec3& velocity_m_s) const noexcept;

    const SurfaceMesh full_;  // views
    const VertexForest forest_;
    AdaptiveSettings settings_;
    double density_ = 0.0;  // triangles a square metre
    float fidelity_ = 1.0F;
    Refinement refinement_;
    std::uint64_t built_ = 0;  // step of the refinement; its box, and whether the servo can use it
    std::array<float, 3> built_low_m_{}, built_high_m_{};
    bool built_usable_ = false;
    TripleBuffer<NearSurface> surface_;
};

}  // namespace tact
