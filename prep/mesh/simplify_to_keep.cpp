#include "prep/mesh/simplify_to_keep.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "prep/mesh/border_distance.hpp"
#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/mesh_stars.hpp"
#include "prep/mesh/relax.hpp"

namespace tact {
namespace {

constexpr std::size_t kDistancePoints = 4000;

Kept kept_with(const TriangleMesh& mesh, const KeepSettings& settings, double boundary_weight,
               const Progress& progress) {
    const SimplifySettings how{.vertices_min = settings.vertices_min,
                               .boundary_weight = boundary_weight,
                               .pair_distance = settings.pair_distance};
    Kept kept{simplify(mesh, how, part(progress, 0.0, 0.5)), boundary_weight};
    relax(mesh, kept.simplified, settings.relax_rounds.value_or(relax_rounds(mesh, kept.simplified)),
          part(progress, 0.5, 1.0));
    return kept;
}

bool is_open(const TriangleMesh& mesh) {
    const MeshStars star(mesh);
    return std::any_of(star.border().begin(), star.border().end(),
                       [](auto next) { return next != UINT32_MAX; });
}

// Distance as a multiple of the best try; 0 if the best is 0.
double multiple(double distance, double best) { return best > 0.0 ? distance / best : 0.0; }

}  // namespace

Kept simplify_to_keep(const TriangleMesh& mesh, const KeepSettings& settings, const Progress& progress) {
    const double usual = settings.boundary_weight.value_or(SimplifySettings{}.boundary_weight);
    if (settings.boundary_weight || mesh.triangles() > kTriedTrianglesMost || !is_open(mesh))
        return kept_with(mesh, settings, usual, progress);
    struct Try {
        Kept kept;
        double surface_m, border_m;
    };
    std::vector<Try> tries;
    for (const double weight : kWeightsTried) {
        const auto share = [&](std::size_t n) { return static_cast<double>(n) / kWeightsTried.size(); };
        Kept kept =
            kept_with(mesh, settings, weight, part(progress, share(tries.size()), share(tries.size() + 1)));
        const TriangleMesh& made = kept.simplified.mesh;
        if (made.triangles() == 0) return kept;  // nothing left to compare
        const double surface_m = two_sided(mesh, made, kDistancePoints).rms_m;
        const double border_m = border_distance_rms_m(mesh, made);
        tries.push_back({std::move(kept), surface_m, border_m});
    }
    double surface_m = 1e300, border_m = 1e300;
    for (const Try& t : tries) {
        surface_m = std::min(surface_m, t.surface_m);
        border_m = std::min(border_m, t.border_m);
    }
    const auto worse = [&](const Try& t) {
        return multiple(t.surface_m, surface_m) + multiple(t.border_m, border_m);
    };
    return std::move(std::min_element(tries.begin(), tries.end(), [&](const Try& a, const Try& b) {
                         return worse(a) < worse(b);
                     })->kept);
}

}  // namespace tact
