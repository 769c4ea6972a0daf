// Position of the vertex that replaces a pair, and its cost.
//
// Frames  displacements from the first vertex of the pair, in the units of the quadrics.
#pragma once

#include <algorithm>

#include "prep/mesh/quadric.hpp"

namespace tact {

struct Place {
    Eigen::Vector3f shift;
    float cost;
};

// The optimum of the quadric. Its condition is tested relative to the sum of its weights: if the planes leave a
// direction undetermined, a pull of kPull towards the middle of the pair decides. An optimum farther than kFar pair
// lengths from the middle is replaced by the best point on the pair.
inline Place best_place(const Quadric& sum, const Eigen::Vector3f& across) {
    constexpr float kPull = 1e-5F;  // 1e-5 to 1e-2 differ by 3 % in RMS; larger values displace corners
    constexpr float kFar = 2.0F;
    const Eigen::Vector3f middle = 0.5F * across;
    Place place{minimum(sum, middle, kPull), 0.0F};
    if (!((place.shift - middle).squaredNorm() <= kFar * kFar * across.squaredNorm())) {
        const float curve = across.dot(sum.times(across));
        const float t = curve > 0.0F ? std::clamp(-across.dot(sum.b()) / curve, 0.0F, 1.0F) : 0.5F;
        place.shift = t * across;
    }
    place.cost = sum(place.shift);
    return place;
}

// Moves the place onto the plane normal . d = height (normal not unit, not zero) along the cheapest direction of the
// quadric. Does nothing if the move is longer than the pair (across).
inline void move_to_plane(const Quadric& sum, const Eigen::Vector3f& across, const Eigen::Vector3f& normal,
                          float height, Place& place) {
    const float length = normal.norm();
    if (!(length > 0.0F)) return;
    const float scale = 1.0F / length;  // dividing a whole vector would divide its unused lane, 0 by 0
    const Eigen::Vector3f g = normal * scale;
    Quadric pulled = sum;
    pulled.bx = -g.x();
    pulled.by = -g.y();
    pulled.bz = -g.z();
    const Eigen::Vector3f way = minimum(pulled, Eigen::Vector3f::Zero(), 1e-5F);
    const float gain = g.dot(way);
    if (!(gain > 0.0F)) return;
    const Eigen::Vector3f move = way * ((height * scale - g.dot(place.shift)) / gain);
    if (!(move.squaredNorm() <= across.squaredNorm())) return;
    place.shift += move;
    place.cost = sum(place.shift);
}

// Moves the place onto the line parallel to a - b on which the curve a ... b keeps its vector area (Lindstrom, Turk
// 1998), to the cheapest point of it. area: the sum of a x u + u x v + ... + w x b over the original curve.
inline void move_to_line(const Quadric& sum, const Eigen::Vector3f& across, const Eigen::Vector3f& a,
                         const Eigen::Vector3f& b, const Eigen::Vector3f& area, Place& place) {
    const Eigen::Vector3f d = a - b;
    const float square = d.squaredNorm();
    if (!(square > 0.0F)) return;
    const Eigen::Vector3f foot = area.cross(d) * (1.0F / square);
    const float curve = d.dot(sum.times(d));
    const float along = curve > 1e-6F * sum.trace() * square ? -d.dot(sum.times(foot) + sum.b()) / curve
                                                             : d.dot(place.shift - foot) / square;
    const Eigen::Vector3f to = foot + along * d;
    if (!((to - 0.5F * across).squaredNorm() <= across.squaredNorm())) return;
    place = {to, sum(to)};
}

}  // namespace tact
