#include "rt/force/surface/shading.hpp"

namespace tact {
namespace {

// Cosines of the angle between facet normal and interpolated normal: full shading above the first (20 degrees), none
// below the second (40 degrees).
constexpr double kShadedFrom = 0.940, kShadedTo = 0.766;

double shaded_share(double cosine) noexcept {
    return std::clamp((cosine - kShadedTo) / (kShadedFrom - kShadedTo), 0.0, 1.0);
}

}  // namespace

Vec3 shaded_turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m, const Vec3& normal,
                   double weight_m) noexcept {
    Vec3 smooth = mesh.normal_at(mesh.point_of(triangle, proxy_m));
    Vec3 facet = mesh.facet_normal(triangle);
    if (facet.dot(normal) < 0.0) {  // the tool is behind the facet
        smooth = -smooth;
        facet = -facet;
    }
    const double share = shaded_share(smooth.dot(facet)) * shaded_share(smooth.dot(normal));
    return weight_m * share * (smooth - normal);
}

}  // namespace tact
