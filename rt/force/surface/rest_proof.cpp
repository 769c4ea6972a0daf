#include "rt/force/surface/rest_proof.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kNeedle =
    1e-8;  // as triangle_query_lanes.hpp: the plane of a thinner triangle is mostly rounding
constexpr double kActive = 1e-6;  // of the pull: smaller weights carry nothing
constexpr double kFineMargins = 1e-4;
constexpr double kParallel = 1e-6;    // squared sine of normals that count as one
constexpr double kIndependent = 0.1;  // cosine: normals nearer to a plane do not fix the place

}  // namespace

bool RestProof::add(const SurfaceMesh& mesh, std::uint32_t triangle, const Vec3& ball_m) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (touch_[i].triangle == triangle) return true;
    }
    const SurfacePoint at = mesh.point_of(triangle, ball_m);
    const double band = kBandMargins * margin_m_;
    if (!(at.distance_m > 0.0) || at.distance_m > radius_m_ + band) return true;
    const auto corner = mesh.corners(triangle);
    const Vec3 a = mesh.position_m(corner[0]), ab = mesh.position_m(corner[1]) - a,
               bc = mesh.position_m(corner[2]) - mesh.position_m(corner[1]);
    const Vec3 across = ab.cross(bc);
    const double square = across.squaredNorm();
    Touch touch;
    touch.triangle = triangle;
    if (square > kNeedle * ab.squaredNorm() * bc.squaredNorm()) {
        const double height = across.dot(ball_m - a) / std::sqrt(square);
        const double aside_square = at.distance_m * at.distance_m - height * height,
                     border = kBorderMargins * margin_m_;
        if (at.part.minCoeff() > 0.0 || aside_square <= border * border) {
            touch.flat = true;
            // A part is a distance from the border over the triangle's height there.
            const double longest =
                std::sqrt(std::max({ab.squaredNorm(), bc.squaredNorm(), (ab + bc).squaredNorm()}));
            touch.inset_m =
                longest > 0.0 ? std::max(at.part.minCoeff(), 0.0) * std::sqrt(square) / longest : 0.0;
            touch.border = !(touch.inset_m > border);
            touch.normal = std::copysign(1.0 / std::sqrt(square), height) * across;
            touch.distance_m = std::abs(height);
        }
    }
    if (!touch.flat) {
        touch.distance_m = at.distance_m;
        touch.normal = (ball_m - at.point_m) / at.distance_m;
        const int zeros = static_cast<int>((at.part.array() <= 0.0).count());
        if (zeros == 1) {
            const Vec3 edge = at.part[0] <= 0.0 ? bc : at.part[1] <= 0.0 ? Vec3(ab + bc) : ab;
            touch.edge = edge.normalized();
        } else if (zeros == 0) {  // a needle
            touch.edge = (ab.squaredNorm() > bc.squaredNorm() ? ab : bc).normalized();
        }
    }
    touch.gap_m = touch.distance_m - (touch.flat ? radius_m_ : radius_m_ - margin_m_);
    if (touch.gap_m > band) return true;
    if (count_ == kTouches) return false;
    // Facets first: they get the weight if an edge has the same normal.
    std::size_t place = count_++;
    if (touch.flat) {
        std::size_t first = 0;
        while (first < place && touch_[first].flat) ++first;
        touch_[place] = touch_[first];
        place = first;
    }
    touch_[place] = touch;
    return true;
}

void RestProof::solve(const Vec3& pull_m) noexcept {
    for (std::size_t i = 0; i < count_; ++i) touch_[i].weight_m = 0.0;
    HalfSpaces::Solution s;
    s.move_m = pull_m;
    const double fine = kFineMargins * margin_m_;
    for (int round = 0; round < HalfSpaces::kRoundsMax; ++round) {
        std::size_t worst = 0;
        double least = -fine;
        for (std::size_t i = 0; i < count_; ++i) {
            const double kept = touch_[i].normal.dot(s.move_m) + touch_[i].gap_m;
            if (kept >= least) continue;
            least = kept;
            worst = i;
        }
        if (least == -fine) break;
        HalfSpaces::Active added;
        added.normal = touch_[worst].normal;
        added.slack_m = touch_[worst].gap_m;
        added.half_space = static_cast<std::uint32_t>(worst);
        if (!HalfSpaces::activate(pull_m, fine, added, s)) break;  // rounding: the rest does not hold
    }
    for (std::size_t i = 0; i < s.active_count; ++i)
        touch_[s.active[i].half_space].weight_m = s.active[i].weight_m;
    residual_m_ = s.move_m;
    lift_m_ = residual_m_ - pull_m;
}

bool RestProof::holds(double friction) const noexcept {
    const double left = residual_m_.norm(), push = lift_m_.norm();
    if (!(left <= friction * push + margin_m_)) return false;
    if (friction <= 0.0) return left <= shape().curvature * margin_m_;
    // Friction bears nothing along the normal: the touch itself has to be exact.
    for (std::size_t i = 0; i < count_; ++i) {
        const Touch& t = touch_[i];
        if (t.weight_m > kActive * push &&
            (t.gap_m < -kBandMargins * margin_m_ || (t.border && !continued(i))))
            return false;
    }
    return true;
}

// Another touched triangle continues the plane of this one.
bool RestProof::continued(std::size_t touch) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (i != touch && touch_[i].flat &&
            touch_[i].normal.cross(touch_[touch].normal).squaredNorm() <= kParallel)
            return true;
    }
    return false;
}

// The distance to the goal (half its square), less the weights times the distances to the edges, along the directions that
// keep the touch: the smallest curvature, and Newton's step to its minimum.
RestProof::Shape RestProof::shape() const noexcept {
    const double least = kActive * lift_m_.norm();
    std::array<Vec3, 2> normal;
    std::size_t normals = 0;
    bool curved = false;
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count_; ++i) {
        const Touch& t = touch_[i];
        if (t.weight_m <= least) continue;
        // The residual may lead off the facet.
        if (t.flat && t.inset_m <= residual_m_.norm() + kBorderMargins * margin_m_ && !continued(i))
            return {0.0, residual_m_};
        if (!t.flat) {
            curved = true;
            bend +=
                t.weight_m / t.distance_m *
                (Eigen::Matrix3d::Identity() - t.normal * t.normal.transpose() - t.edge * t.edge.transpose());
        }
        if (normals == 0) {
            normal[normals++] = t.normal;
        } else if (normals == 1) {
            const Vec3 both = normal[0].cross(t.normal);
            if (both.squaredNorm() > kParallel) normal[normals++] = both.normalized();
        } else if (std::abs(normal[1].dot(t.normal)) > kIndependent) {
            return {1.0, residual_m_};  // three independent normals fix the place
        }
    }
    if (!curved) return {1.0, residual_m_};
    if (normals == 2) {
        const Vec3& u = normal[1];
        const double left = 1.0 - u.dot(bend * u);
        if (left < kStable) return {};
        return {left, residual_m_ + u.dot(residual_m_) * (1.0 / left - 1.0) * u};
    }
    const Vec3 u = normal[0].unitOrthogonal(), v = normal[0].cross(u);
    const double a = 1.0 - u.dot(bend * u), b = -u.dot(bend * v), c = 1.0 - v.dot(bend * v);
    const double left = 0.5 * (a + c) - std::hypot(0.5 * (a - c), b);
    if (left < kStable) return {};
    const double along_u = u.dot(residual_m_), along_v = v.dot(residual_m_), det = a * c - b * b;
    const double to_u = (c * along_u - b * along_v) / det, to_v = (a * along_v - b * along_u) / det;
    return {left, residual_m_ + (to_u - along_u) * u + (to_v - along_v) * v};
}

}  // namespace tact
