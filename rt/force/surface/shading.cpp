#include "rt/force/surface/shading.hpp"

#include <algorithm>

namespace tact {
namespace {

// Cosines of the angle between facet normal and interpolated normal: full shading above the first (20 degrees), none
// below the second (40 degrees).
constexpr double kShadedFrom = 0.940, kShadedTo = 0.766;

double shaded_share(double cosine) noexcept {
    return std::clamp((cosine - kShadedTo) / (kShadedFrom - kShadedTo), 0.0, 1.0);
}

Vec3 turn_to(Vec3 smooth, Vec3 facet, const Vec3& normal, double weight_m) noexcept {
    if (facet.dot(normal) < 0.0) {  // the tool is behind the facet
        smooth = -smooth;
        facet = -facet;
    }
    const double share = shaded_share(smooth.dot(facet)) * shaded_share(smooth.dot(normal));
    return weight_m * share * (smooth - normal);
}

}  // namespace

Vec3 shaded_turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m, const Vec3& normal,
                   double weight_m) noexcept {
    return turn_to(mesh.normal_at(mesh.point_of(triangle, proxy_m)), mesh.facet_normal(triangle), normal,
                   weight_m);
}

Vec3 ShadedFacet::turn_m(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& proxy_m,
                         const Vec3& normal, double weight_m) noexcept {
    if (triangle != triangle_) {
        triangle_ = triangle;
        const auto corner = mesh.corners(triangle);
        corner_m_ = mesh.position_m(corner[0]);
        const Vec3 ab = mesh.position_m(corner[1]) - corner_m_, ac = mesh.position_m(corner[2]) - corner_m_;
        facet_ = mesh.facet_normal(triangle);
        const Vec3 across = ab.cross(ac);
        const double square = across.squaredNorm();
        thin_ = !(square > 0.0);
        per_b_ = ac.cross(across) / square;
        per_c_ = across.cross(ab) / square;
        smooth_ = mesh.normal(corner[0]);
        smooth_b_ = mesh.normal(corner[1]) - smooth_;
        smooth_c_ = mesh.normal(corner[2]) - smooth_;
    }
    const Vec3 from_m = proxy_m - corner_m_;
    const double b = per_b_.dot(from_m), c = per_c_.dot(from_m);
    const Vec3 sum = smooth_ + b * smooth_b_ + c * smooth_c_;
    const double length = sum.norm();
    if (thin_ || !(b >= 0.0 && c >= 0.0 && b + c <= 1.0 && length > 1e-6))
        return shaded_turn_m(mesh, triangle, proxy_m, normal, weight_m);
    return turn_to(sum / length, facet_, normal, weight_m);
}

}  // namespace tact
