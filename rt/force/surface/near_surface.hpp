// The triangles around the probe as a surface of their own, with its tree: what the contact looks at instead of
// the full mesh.
//
// Order     along a curve through their box, four a leaf, as the full mesh's.
// Normals   those of the full mesh at the corners that each triangle stands for.
// Memory    about 120 bytes for each triangle that may be there, taken by the constructor.
// Thread    build() on the thread that refines; then the servo reads. No allocation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ipc/assets/near_triangles.hpp"
#include "ipc/assets/surface_mesh.hpp"

namespace tact {

class NearSurface {
public:
    NearSurface() = default;
    explicit NearSurface(std::uint32_t capacity);
    // `full` is the mesh that the forest is over.
    void build(const NearTriangles& near, const SurfaceMesh& full) noexcept;

    // Empty: nothing was built, or not all of it fitted, or it is not as in the full mesh.
    [[nodiscard]] bool holds(const Vec3& centre_m, double radius_m) const noexcept TACT_RT {
        return usable_ && ((centre_m.array() - radius_m) >= low_m_.array()).all() &&
               ((centre_m.array() + radius_m) <= high_m_.array()).all();
    }
    // A view on this buffer.
    [[nodiscard]] SurfaceMesh mesh() const noexcept TACT_RT;
    [[nodiscard]] std::uint32_t triangles() const noexcept TACT_RT { return count_; }
    [[nodiscard]] std::uint64_t step() const noexcept TACT_RT { return step_; }

private:
    struct Keyed {
        std::uint32_t key, from;
    };
    void sort(const NearTriangles& near) noexcept;
    void make_tree() noexcept;
    std::uint32_t make_node(std::uint32_t first_leaf, std::uint32_t leaves) noexcept;

    bool usable_ = false;
    Vec3 low_m_ = Vec3::Zero(), high_m_ = Vec3::Zero();
    std::uint32_t count_ = 0, nodes_ = 0;
    std::uint64_t step_ = 0;
    std::vector<float> position_m_;
    std::vector<OctNormal> normal_;
    std::vector<std::uint32_t> corner_;  // 0, 1, 2, …
    std::vector<SurfaceNode> node_;
    std::vector<Keyed> keyed_, other_;
};

}  // namespace tact
