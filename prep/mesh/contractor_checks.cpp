// Checks that reject a contraction.
//
// Detecting folds over the edges opposite the new vertex needs triangles farther away, which is expensive. So each
// vertex keeps an upper bound of |n - m| over the pairs of unit normals at its edges. A contraction turns a normal by
// a known chord, so the bound grows by that chord; the true value is computed only if the bound permits a fold, which
// is the case in a few of a hundred contractions.
#include <algorithm>
#include <cmath>

#include "prep/mesh/contractor.hpp"

namespace tact {
namespace {

constexpr float kFoldChord = 1.922F;  // |n - m| at kFoldCosine, minus a margin
constexpr float kThin = 1e-3F;
// For opposes(): the limit as a multiple of the error level (0.3 takes longer, 1 leaves flipped triangles), the chord of a
// turn that is not checked, and the work per vertex, which bounds the time where most pairs are refused, near the end.
constexpr float kOpposed = 0.5F;
constexpr float kOpposedTurn = 0.2F;
constexpr double kOpposedWork = 16.0;
constexpr float kBendUnit = 2.0F / 255.0F;

// 4 sqrt(3) area / sum of squared sides: 1 for an equilateral triangle.
float roundness(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float double_area) {
    const float sides = a.squaredNorm() + b.squaredNorm() + (a - b).squaredNorm();
    return sides > 0.0F ? 3.4641016F * double_area / sides : 0.0F;
}

float chord(float cosine) { return std::sqrt(std::max(0.0F, 2.0F - 2.0F * cosine)); }

std::uint8_t rounded_up(float bend) {
    return static_cast<std::uint8_t>(std::min(255.0F, bend * (1.0F / kBendUnit) + 1.0F));
}

}  // namespace

// Link condition: the common neighbours of the pair are exactly those opposite it in its own triangles.
bool Contractor::topology_allows(std::uint32_t u, std::uint32_t v) {
    const Vertex &a = vertex_[u], &b = vertex_[v];
    std::uint32_t shared = 0, common = 0;
    for (const Wing& wing : star_u_) shared += (wing.next == v || wing.last == v) ? 1 : 0;
    if (shared == 0) return false;
    const bool both_border = (a.stamp & b.stamp & kBorder) != 0;
    // Would pinch the sheet; allowed only together with pairs without an edge.
    if (both_border && shared == 2 && !(settings_.pair_distance > 0.0)) return false;
    if (a.count + b.count <= 2 * shared + 1) return false;
    if (!both_border && a.count == 3 && b.count == 3) return false;  // would flatten a tetrahedron
    if (((a.stamp | b.stamp) & kBorder) == 0 && a.count <= 24) {
        // Around an inner vertex every neighbour is the `next` corner of one triangle.
        for (const Wing& wing : star_v_) {
            for (const Wing& other : star_u_) common += wing.next == other.next ? 1 : 0;
        }
        return common == shared;
    }
    gather(u);
    for (const Wing& wing : star_v_) {
        for (const std::uint32_t w : {wing.next, wing.last}) {
            if (w == u || mark_[w] != epoch_) continue;
            mark_[w] = epoch_ - 1;  // count it once
            ++common;
        }
    }
    return common == shared;
}

bool Contractor::turns_over(const Star& star, std::uint32_t other, const Eigen::Vector3f& from,
                            const Eigen::Vector3f& to, const Side<float>& side) {
    for (const Wing& wing : star) {
        if (wing.next == other || wing.last == other) continue;
        const Eigen::Vector3f before = (wing.p_next - from).cross(wing.p_last - from);
        const Eigen::Vector3f after = (wing.p_next - to).cross(wing.p_last - to);
        const float area = after.norm(), was = before.norm();
        const float cosine = before.dot(after) * (1.0F / (was * area));
        const bool turns = !(cosine > kTurnCosine<float>);
        // The normal of a needle-shaped triangle is undefined.
        if (turns || roundness(wing.p_next - to, wing.p_last - to, area) < kThin) {
            if (roundness(wing.p_next - from, wing.p_last - from, was) > kThin) return true;
        }
        if (side.left_by(before, was, after, area)) return true;
        Leaf leaf{wing.next, wing.last, other, 2.0F, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
        if (area > 0.0F) leaf.normal = after * (1.0F / area);
        if (!turns) {
            leaf.before = before * (1.0F / was);
            leaf.turn = chord(cosine);
        }
        leaf_.push_back(leaf);
    }
    return false;
}

// True if two neighbouring triangles at the new vertex, or one of them and the triangle across its outer edge, would be
// nearly face to face. A fold that existed before may stay.
bool Contractor::folds(std::uint32_t u, std::uint32_t v, bool joining) {
    joint_.clear();
    for (const Leaf& a : leaf_) {
        for (const Leaf& b : leaf_) {
            if (a.last != b.next || (joining && a.next == b.last)) continue;
            const float cosine = a.normal.dot(b.normal);
            const bool was_folded = a.other == b.other && a.before.dot(b.before) < kFoldCosine<float>;
            if (cosine < kFoldCosine<float> && !was_folded) return true;
            joint_.push_back({a.last, chord(cosine), std::max(a.turn, b.turn)});
        }
    }
    for (const Leaf& leaf : leaf_) {
        const float bend = kBendUnit * static_cast<float>(std::min(bend_[leaf.next], bend_[leaf.last]));
        if (bend + leaf.turn > kFoldChord && folds_outward(leaf, u, v)) return true;
    }
    return false;
}

bool Contractor::folds_outward(const Leaf& leaf, std::uint32_t u, std::uint32_t v) {
    measure_bend(leaf.next);
    const Vertex& vertex = vertex_[leaf.next];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        const Corners& c = triangle_[touch_[vertex.first + i]];
        for (std::size_t k = 0; k < 3; ++k) {
            if (c[(k + 1) % 3] != leaf.last || c[(k + 2) % 3] != leaf.next || c[k] == u || c[k] == v)
                continue;
            const Eigen::Vector3f n = double_area(c);
            const float limit = kFoldCosine<float> * n.norm();
            if (leaf.normal.dot(n) < limit && !(leaf.before.dot(n) < limit)) return true;
        }
    }
    return false;
}

// Sets the bound of w to the present value.
void Contractor::measure_bend(std::uint32_t w) {
    float bend = 0.0F;
    fan_.clear();
    const Vertex& vertex = vertex_[w];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        const Corners& c = triangle_[touch_[vertex.first + i]];
        const bool first = c[0] == w, second = c[1] == w;
        const Eigen::Vector3f n = double_area(c);
        const float length = n.norm();
        fan_.push_back({first    ? c[1]
                        : second ? c[2]
                                 : c[0],
                        first    ? c[2]
                        : second ? c[0]
                                 : c[1],
                        n * (length > 0.0F ? 1.0F / length : 0.0F)});
    }
    for (const Blade& a : fan_) {
        for (const Blade& b : fan_) {
            if (a.last == b.next) bend = std::max(bend, chord(a.normal.dot(b.normal)));
        }
    }
    bend_[w] = rounded_up(bend);
}

// Updates the bounds around the new vertex after an accepted contraction.
void Contractor::note_bends(std::uint32_t u) {
    const auto add = [&](std::uint32_t w, float turn) {
        const unsigned sum = unsigned{bend_[w]} + rounded_up(turn);
        bend_[w] = static_cast<std::uint8_t>(std::min(255U, sum));
    };
    float largest = 0.0F;
    for (const Joint& joint : joint_) {
        largest = std::max(largest, joint.bend);
        add(joint.w, joint.turn);
        bend_[joint.w] = std::max(bend_[joint.w], rounded_up(joint.bend));
    }
    bend_[u] = rounded_up(largest);
    if (joint_.size() == leaf_.size()) return;
    for (const Leaf& leaf : leaf_) {  // at a border, some edges have only one triangle
        add(leaf.next, leaf.turn);
        add(leaf.last, leaf.turn);
    }
}

bool Contractor::spoils(std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across,
                        const Eigen::Vector3f& to, bool joining) {
    leaf_.clear();
    const Eigen::Vector4f facing = facing_[u] + facing_[v];
    const Side<float> side(facing.head<3>(), facing.w());
    return turns_over(star_u_, v, Eigen::Vector3f::Zero(), to, side) ||
           turns_over(star_v_, u, across, to, side) || folds(u, v, joining);
}

// True if a triangle would face away from the original by more than the error level, and by more than before. spoils()
// has listed the triangles.
bool Contractor::opposes(const Quadric& sum, std::uint32_t u, std::uint32_t v, const Eigen::Vector3f& across,
                         const Place& place) {
    if (static_cast<double>(original_.work()) > kOpposedWork * static_cast<double>(vertex_.size()))
        return false;
    const Eigen::Vector4f facing = facing_[u] + facing_[v];
    const auto suspect = [&](const Eigen::Vector3f& normal, const Eigen::Vector4f& f) {
        return normal.dot(f.head<3>()) < 0.0F;
    };
    const auto model = [&](const Eigen::Vector3f& p) -> Eigen::Vector3d {
        return centre_ + extent_ * p.cast<double>();
    };
    for (const Leaf& leaf : leaf_) {
        if (leaf.turn < kOpposedTurn) continue;
        if (!suspect(leaf.normal, facing) && !suspect(leaf.normal, facing_[leaf.next]) &&
            !suspect(leaf.normal, facing_[leaf.last]))
            continue;
        const double limit_m =
            extent_ * static_cast<double>(kOpposed * std::sqrt(square_level(sum, across, place)));
        const Eigen::Vector3d to = model(vertex_[u].at() + place.shift);
        Opposed::Face face{{u, leaf.next, leaf.last},
                           {to, model(vertex_[leaf.next].at()), model(vertex_[leaf.last].at())}};
        original_.join(u, v);  // a second time parts them again
        const double after = original_.opposed_m(face, limit_m);
        original_.join(u, v);
        if (after <= limit_m) continue;
        face.vertex[0] = leaf.other == v ? u : v;
        face.corner[0] = model(vertex_[face.vertex[0]].at());
        if (after > original_.opposed_m(face, limit_m)) return opposed_ = true;
    }
    return false;
}

}  // namespace tact
