// Limits the largest distance, which quadrics of mean error do not: where the planes around a spike meet far outside it,
// or where a small spike is lost, the mean over all planes is small.
//
// Both limits compare one step with the error level of the sequence: the new vertex lies within kOvershoot times that
// level of the surface before, and the two vertices before, and the farthest point that was lost earlier at them, lie
// within that level of the surface after. They apply where the surface that the pair represents is bent; elsewhere
// planes and distances agree, and the limits would take a third of the time.
#include <algorithm>
#include <cmath>

#include "prep/mesh/contractor.hpp"
#include "prep/mesh/nearest_point.hpp"

namespace tact {
namespace {

constexpr float kBent = 0.97F;      // |sum of areas| / sum of |areas|; 1: flat
constexpr float kOvershoot = 0.8F;  // 1.0 to 0.7: largest distances of spikes 1.2 to 0.9, RMS 1.00 to 1.03
constexpr float kPatience =
    1.0F / 16.0F;                 // of the cost at which a pair is tried; 1: gears lose 1.13 times as much
constexpr float kWitness = 0.5F;  // lost points within this part of the limit are not remembered
constexpr float kLeast = 1e-3F;   // of the pair's length: rounding

// Squared distance of the origin to a triangle, by Voronoi region as in nearest_point.hpp.
float square_to(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    const Eigen::Vector3f ab = b - a, ac = c - a;
    const float d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0 && d2 <= 0) return a.squaredNorm();
    const float d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0 && d4 <= d3) return b.squaredNorm();
    const float d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0 && d5 <= d6) return c.squaredNorm();
    const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return (a + ab * (d1 / (d1 - d3))).squaredNorm();
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return (a + ac * (d2 / (d2 - d6))).squaredNorm();
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).squaredNorm();
    const float scale = 1.0F / (va + vb + vc);
    return (a + ab * (vb * scale) + ac * (vc * scale)).squaredNorm();
}

}  // namespace

bool Contractor::bent(std::uint32_t u, std::uint32_t v) const {
    const Eigen::Vector4f facing = facing_[u] + facing_[v];
    return !(facing.head<3>().norm() > kBent * facing.w());
}

// The square of the error level that this contraction would reach. A refused pair returns at twice the cost, so that it
// is contracted once what it loses is due.
float Contractor::square_level(const Quadric& sum, const Eigen::Vector3f& across, const Place& place) const {
    const float own = std::max(place.cost, kPatience * tried_at_) / std::max(sum.trace(), 1e-30F);
    return std::max({error_ * error_, own, kLeast * kLeast * across.squaredNorm()});
}

// Moves a place that is too far from the triangles of the pair towards the nearest point of these.
void Contractor::pull_back(const Quadric& sum, const Eigen::Vector3f& across, Place& place) const {
    const float limit = kOvershoot * kOvershoot * square_level(sum, across, place);
    const float from_u = place.shift.squaredNorm(), from_v = (place.shift - across).squaredNorm();
    float best = std::min(from_u, from_v);
    if (best <= limit) return;
    const Wing* nearest = nullptr;
    Eigen::Vector3f self = Eigen::Vector3f::Zero();
    if (from_v < from_u) self = across;
    Eigen::Vector3f to = self;
    const auto near = [&](const Star& star, const Eigen::Vector3f& centre) {
        const Eigen::Vector3f a = centre - place.shift;
        for (const Wing& wing : star) {
            const float square = square_to(a, wing.p_next - place.shift, wing.p_last - place.shift);
            if (!(square < best)) continue;
            best = square;
            nearest = &wing;
            self = centre;
            if (best <= limit) return true;
        }
        return false;
    };
    if (near(star_u_, Eigen::Vector3f::Zero()) || near(star_v_, across)) return;
    if (nearest != nullptr) {
        const auto part = nearest_point(place.shift.cast<double>(), self.cast<double>(),
                                        nearest->p_next.cast<double>(), nearest->p_last.cast<double>())
                              .part;
        to = static_cast<float>(part[0]) * self + static_cast<float>(part[1]) * nearest->p_next +
             static_cast<float>(part[2]) * nearest->p_last;
    }
    place.shift = to + (place.shift - to) * std::sqrt(limit / best);
    place.cost = sum(place.shift);
}

// Squared distance of p to the triangles that the new vertex would have; may stop below `enough`.
float Contractor::to_new_star(const Eigen::Vector3f& p, std::uint32_t u, std::uint32_t v,
                              const Eigen::Vector3f& to, float enough) const {
    const Eigen::Vector3f a = to - p;
    float best = a.squaredNorm();
    const auto near = [&](const Star& star, std::uint32_t other) {
        for (const Wing& wing : star) {
            if (best <= enough) return;
            if (wing.next == other || wing.last == other) continue;
            best = std::min(best, square_to(a, wing.p_next - p, wing.p_last - p));
        }
    };
    near(star_u_, v);
    near(star_v_, u);
    return best;
}

// True if a point would be lost. Otherwise sets the point that the new vertex has to remember.
bool Contractor::loses(const Quadric& sum, std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across,
                       const Place& place) {
    const float limit = square_level(sum, across, place), remembered = kWitness * kWitness * limit;
    const Eigen::Vector3f origin = vertex_[u].at();
    float farthest = remembered;
    lost_next_ = {};
    const auto check = [&](const Eigen::Vector3f& p) {
        const float square = to_new_star(p, u, v, place.shift, remembered);
        if (square > farthest) {
            farthest = square;
            lost_next_ = {p.x() + origin.x(), p.y() + origin.y(), p.z() + origin.z(), 1.0F};
        }
        return square > limit;
    };
    if (check(Eigen::Vector3f::Zero()) || check(across)) return true;
    for (const std::uint32_t w : {u, v}) {
        const Lost& lost = lost_[w];
        if (lost[3] != 0.0F && check(Eigen::Vector3f(lost[0], lost[1], lost[2]) - origin)) return true;
    }
    return false;
}

}  // namespace tact
