// One level of a mesh, for export: contracts, moves the vertices nearer to the original, and chooses the border weight
// of a small open mesh.
//
// Weight    the number of remaining vertices on the border changes with f in steps, and no f suits every shape and
//           size. So for small open meshes kWeightsTried are tried, and the one with the least sum of surface and
//           border distance is kept, each as a multiple of the best try.
// Cost      per try, that of simplify and relax.  Thread  any but the servo's.  Fails by  as simplify.
#pragma once

#include <array>
#include <optional>

#include "prep/mesh/simplify.hpp"

namespace tact {

inline constexpr std::array kWeightsTried{100.0, 140.0, 200.0, 300.0};
inline constexpr std::size_t kTriedTrianglesMost = 20000;

struct KeepSettings {
    std::uint32_t vertices_min = 4;
    std::optional<double> boundary_weight{};      // f; absent: chosen automatically
    std::optional<std::uint32_t> relax_rounds{};  // absent: relax_rounds() of relax.hpp
    double pair_distance = 0.0;                   // as in SimplifySettings
};

struct Kept {
    Simplified simplified;
    double boundary_weight = 0.0;  // the weight used
};

Kept simplify_to_keep(const TriangleMesh& mesh, const KeepSettings& settings, const Progress& progress = {});

}  // namespace tact
