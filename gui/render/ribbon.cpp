#include "gui/render/ribbon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gui/render/tube_parts.hpp"

namespace tact {
namespace {

using Eigen::Vector3f;

constexpr float kCoilA = 0.35F, kNucleicA = 0.75F, kThickA = 0.3F, kHelixA = 1.35F, kStrandA = 1.1F,
                kArrowA = 1.9F;  // half widths
constexpr std::uint8_t kCarbon = 6;

struct RibbonDetail {
    int steps, sides;
};
constexpr RibbonDetail kRibbonDetails[] = {{6, 10}, {5, 8}, {4, 8}, {3, 8}, {3, 6}, {2, 6}, {2, 4}, {1, 4}};

// Of one residue.
struct Shape {
    float wide_a, thick_a;
};
Shape shape_of(Fold fold, bool nucleic) {
    if (nucleic) return {kNucleicA, kNucleicA};
    if (fold == Fold::helix) return {kHelixA, kThickA};
    if (fold == Fold::strand) return {kStrandA, kThickA};
    return {kCoilA, kCoilA};
}

class Ribbon {
public:
    Ribbon(const Structure& s, const std::vector<std::uint32_t>& atoms, const std::vector<Fold>& folds)
        : folds_(folds), nucleic_(s.element[atoms.front()] != kCarbon) {
        std::vector<Vector3f> raw;
        raw.reserve(atoms.size());
        for (const std::uint32_t atom : atoms) raw.push_back(point_a(s, atom));
        point_ = raw;
        for (std::size_t i = 1; i + 1 < raw.size(); ++i)
            if (folds[i] == Fold::strand) point_[i] = 0.25F * (raw[i - 1] + 2.0F * raw[i] + raw[i + 1]);
        // Across the ribbon: along a helix's axis, and within a sheet. The zigzag of a strand turns it over at each atom.
        side_.assign(raw.size(), Vector3f::Zero());
        for (std::size_t i = 1; i + 1 < raw.size(); ++i) {
            const Vector3f across = (raw[i] - raw[i - 1]).cross(raw[i + 1] - raw[i]);
            side_[i] = across.norm() > 1e-3F ? across.normalized() : side_[i - 1];
            if (side_[i].dot(side_[i - 1]) < 0.0F) side_[i] = -side_[i];
        }
        side_.front() = raw.size() > 2 ? side_[1] : Vector3f::UnitX();
        side_.back() = raw.size() > 2 ? side_[raw.size() - 2] : Vector3f::UnitX();
    }

    void add_to(TubeMesh& mesh, RibbonDetail detail, const std::vector<Rgb8>& colour) const {
        const std::size_t count = (point_.size() - 1) * static_cast<std::size_t>(detail.steps) + 1;
        const auto place = [&](std::size_t k) {
            const std::size_t i = std::min(k / static_cast<std::size_t>(detail.steps), point_.size() - 2);
            const float t = static_cast<float>(k - i * static_cast<std::size_t>(detail.steps)) /
                            static_cast<float>(detail.steps);
            return std::pair{i, t};
        };
        std::vector<Vector3f> curve;
        for (std::size_t k = 0; k < count; ++k) {
            const auto [i, t] = place(k);
            curve.push_back(catmull_rom(point_, i, t));
        }
        std::uint32_t previous = 0;
        Vector3f before = Vector3f::Zero();
        for (std::size_t k = 0; k < count; ++k) {
            const auto [i, t] = place(k);
            Vector3f along = curve[std::min(k + 1, count - 1)] - curve[k > 0 ? k - 1 : 0];
            along = along.norm() > 1e-6F ? along.normalized() : Vector3f::UnitZ();
            Vector3f u = (1.0F - t) * side_[i] + t * side_[i + 1];
            u -= along * along.dot(u);
            if (u.norm() < 1e-3F) u = before - along * along.dot(before);
            if (u.norm() < 1e-3F) u = along.unitOrthogonal();
            u.normalize();
            before = u;
            const Shape shape = shape_at(i, t);
            const auto ring = static_cast<std::uint32_t>(mesh.vertex.size());
            const Rgb8& c = colour[t < 0.5F ? i : i + 1];
            add_ring(mesh, curve[k], shape.wide_a * u, shape.thick_a * along.cross(u), detail.sides, c);
            const float tip_a = 0.6F * shape.thick_a;
            if (k > 0) join_rings(mesh, previous, ring, detail.sides);
            if (k == 0) close_end(mesh, curve[k] - tip_a * along, -along, ring, detail.sides, false, c);
            if (k + 1 == count) close_end(mesh, curve[k] + tip_a * along, along, ring, detail.sides, true, c);
            previous = ring;
        }
    }

private:
    // Between the residues i and i + 1. The arrow of a strand begins one residue before its last.
    [[nodiscard]] Shape shape_at(std::size_t i, float t) const {
        const Shape a = shape_of(folds_[i], nucleic_), b = shape_of(folds_[i + 1], nucleic_);
        const bool strand = folds_[i] == Fold::strand && folds_[i + 1] == Fold::strand,
                   ends = i + 2 >= folds_.size() || folds_[i + 2] != Fold::strand;
        if (strand && ends) return {(1.0F - t) * kArrowA + t * kCoilA, kThickA};
        const bool after_arrow = folds_[i] == Fold::strand && !strand;
        const float s = t * t * (3.0F - 2.0F * t);
        const float from_a = after_arrow ? kCoilA : a.wide_a;
        return {(1.0F - s) * from_a + s * b.wide_a, (1.0F - s) * a.thick_a + s * b.thick_a};
    }

    const std::vector<Fold>& folds_;
    bool nucleic_;
    std::vector<Vector3f> point_, side_;
};

}  // namespace

std::vector<std::vector<Fold>> folds_of(const Structure& s) {
    std::vector<std::vector<Vector3f>> chains;
    for (const auto& atoms : strands_of(s)) {
        chains.emplace_back();
        for (const std::uint32_t atom : atoms)
            if (s.element[atom] == kCarbon) chains.back().push_back(point_a(s, atom));
        if (chains.back().size() != atoms.size()) chains.back().assign(atoms.size(), Vector3f::Zero());
    }
    return folds_of(chains);
}

TubeMesh build_ribbons(const Structure& structure, const std::vector<std::vector<Fold>>& folds,
                       std::size_t vertices_max, std::span<const Rgb8> paint) {
    const auto strands = strands_of(structure);
    std::size_t points = 0;
    for (const auto& atoms : strands) points += atoms.size();
    const auto* const end = std::end(kRibbonDetails);
    const auto* const detail = std::find_if(std::begin(kRibbonDetails), end, [&](const RibbonDetail& d) {
        return points * static_cast<std::size_t>(d.steps * d.sides) <= vertices_max;
    });
    if (detail == end) return build_tubes(structure, vertices_max, paint);
    TubeMesh mesh;
    mesh.strands = strands.size();
    for (std::size_t k = 0; k < strands.size(); ++k) {
        std::vector<Rgb8> colour;
        for (const std::uint32_t atom : strands[k])
            colour.push_back(paint.empty() ? chain_colour(structure.chain[atom]) : paint[atom]);
        Ribbon(structure, strands[k], folds[k]).add_to(mesh, *detail, colour);
    }
    return mesh;
}

}  // namespace tact
