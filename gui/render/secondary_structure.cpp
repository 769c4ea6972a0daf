#include "gui/render/secondary_structure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tact {
namespace {

using Eigen::Vector3f;
using Chain = std::vector<Vector3f>;

// Mean and half width of a range.
struct Range {
    float mean, half;
    [[nodiscard]] bool has(float value) const { return std::abs(value - mean) <= half; }
    [[nodiscard]] bool has_angle(float degrees) const {
        return std::abs(std::remainder(degrees - mean, 360.0F)) <= half;
    }
};
struct Geometry {
    Range to_2, to_3, to_4;  // distances from the atom before to those 2, 3 and 4 further on
    Range angle, dihedral;
};
constexpr Geometry kHelix{{5.5F, 0.5F}, {5.3F, 0.5F}, {6.4F, 0.6F}, {89.0F, 12.0F}, {50.0F, 20.0F}};
constexpr Geometry kStrand{{6.7F, 0.6F}, {9.9F, 0.9F}, {12.4F, 1.1F}, {124.0F, 14.0F}, {-170.0F, 45.0F}};
constexpr std::size_t kHelixLeast = 5, kStrandLeast = 3, kStrandAlone = 5;
constexpr Range kContact{4.8F, 0.7F};  // of neighbour strands
constexpr std::ptrdiff_t kFarInChain = 3;

float degrees(float radians) { return radians * 57.29578F; }

float angle_at(const Chain& c, std::size_t i) {
    const Vector3f a = (c[i - 1] - c[i]).normalized(), b = (c[i + 1] - c[i]).normalized();
    return degrees(std::acos(std::clamp(a.dot(b), -1.0F, 1.0F)));
}

float dihedral_at(const Chain& c, std::size_t i) {
    const Vector3f a = c[i] - c[i - 1], b = c[i + 1] - c[i], d = c[i + 2] - c[i + 1];
    const Vector3f u = a.cross(b), v = b.cross(d);
    return degrees(std::atan2(b.norm() * a.dot(v), u.dot(v)));
}

bool fits(const Chain& c, std::size_t i, const Geometry& g, bool with_2) {
    if (i < 1 || i + 2 >= c.size()) return false;
    const bool far = i + 3 < c.size() && g.to_3.has((c[i + 2] - c[i - 1]).norm()) &&
                     g.to_4.has((c[i + 3] - c[i - 1]).norm()) &&
                     (!with_2 || g.to_2.has((c[i + 1] - c[i - 1]).norm()));
    // Distances are the same in a mirror.
    if (far && !with_2 && dihedral_at(c, i) < 0.0F) return false;
    return far || (g.angle.has_angle(angle_at(c, i)) && g.dihedral.has_angle(dihedral_at(c, i)));
}

bool nearly_fits(const Chain& c, std::size_t i, const Geometry& g) {
    if (i < 1 || i + 1 >= c.size()) return false;
    return (i + 2 < c.size() && g.to_3.has((c[i + 2] - c[i - 1]).norm())) ||
           g.angle.has_angle(angle_at(c, i));
}

struct Run {
    std::size_t begin, end;
    [[nodiscard]] std::size_t length() const { return end - begin; }
};
std::vector<Run> runs_of(const std::vector<bool>& is) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (!is[i]) continue;
        if (i == 0 || !is[i - 1]) runs.push_back({i, i});
        runs.back().end = i + 1;
    }
    return runs;
}

// One more residue at either end, where the geometry nearly is that of the fold.
void mark(std::vector<Fold>& folds, const Chain& c, Run run, Fold fold, const Geometry& g) {
    if (run.begin > 0 && nearly_fits(c, run.begin - 1, g)) --run.begin;
    if (run.end < c.size() && nearly_fits(c, run.end, g)) ++run.end;
    for (std::size_t i = run.begin; i < run.end; ++i)
        if (folds[i] == Fold::coil) folds[i] = fold;
}

}  // namespace

std::vector<std::vector<Fold>> folds_of(const std::vector<std::vector<Vector3f>>& chains) {
    std::vector<std::vector<Fold>> folds;
    std::vector<std::vector<bool>> extended;
    for (const Chain& c : chains) {
        std::vector<bool> helix(c.size()), strand(c.size());
        for (std::size_t i = 0; i < c.size(); ++i) {
            helix[i] = fits(c, i, kHelix, false);
            strand[i] = !helix[i] && fits(c, i, kStrand, true);
        }
        folds.emplace_back(c.size(), Fold::coil);
        for (const Run& run : runs_of(helix))
            if (run.length() >= kHelixLeast) mark(folds.back(), c, run, Fold::helix, kHelix);
        for (std::size_t i = 0; i < c.size(); ++i)
            if (folds.back()[i] == Fold::helix) strand[i] = false;
        extended.push_back(std::move(strand));
    }
    const auto touches = [&](std::size_t chain, std::size_t i) {
        for (std::size_t other = 0; other < chains.size(); ++other)
            for (std::size_t k = 0; k < chains[other].size(); ++k) {
                const bool near = other == chain && std::abs(static_cast<std::ptrdiff_t>(k) -
                                                             static_cast<std::ptrdiff_t>(i)) <= kFarInChain;
                if (extended[other][k] && !near && kContact.has((chains[other][k] - chains[chain][i]).norm()))
                    return true;
            }
        return false;
    };
    for (std::size_t chain = 0; chain < chains.size(); ++chain)
        for (const Run& run : runs_of(extended[chain])) {
            if (run.length() < kStrandLeast) continue;
            std::size_t contacts = 0;
            for (std::size_t i = run.begin; i < run.end && run.length() < kStrandAlone; ++i)
                contacts += touches(chain, i) ? 1 : 0;
            if (run.length() >= kStrandAlone || contacts > 0)
                mark(folds[chain], chains[chain], run, Fold::strand, kStrand);
        }
    return folds;
}

}  // namespace tact
