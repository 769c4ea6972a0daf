// One level of a mesh, to keep: contracted, its vertices then moved nearer to the original, and a small open
// mesh with the weight of its border that suits it.
//
// Weight    how many of the vertices that are left stand on the border follows from f by leaps, and no f
//           is good for every shape and size. So where the mesh is open and small, kWeightsTried are
//           tried, and the one with the least sum of surface and border distance is kept, each as a
//           multiple of the best one tried.
// Cost      of each try that of simplify and relax.  Thread  any but the servo's.  Fails by  as simplify.
#pragma once

#include <array>
#include <optional>

#include "prep/mesh/simplify.hpp"

namespace tact {

inline constexpr std::array kWeightsTried{100.0, 140.0, 200.0, 300.0};
inline constexpr std::size_t kTriedTrianglesMost = 20000;

struct KeepSettings {
    std::uint32_t vertices_min = 4;
    std::optional<double> boundary_weight{};      // f; none: by itself
    std::optional<std::uint32_t> relax_rounds{};  // none: relax_rounds() of relax.hpp
    double pair_distance = 0.0;                   // as of SimplifySettings
};

struct Kept {
    Simplified simplified;
    double boundary_weight = 0.0;  // that it was made with
};

Kept simplify_to_keep(const TriangleMesh& mesh, const KeepSettings& settings, const Progress& progress = {});

}  // namespace tact
