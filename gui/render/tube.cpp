#include "gui/render/tube.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/render/tube_parts.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

using Eigen::Vector3f;

// Steps of the curve per point, sides of the tube, and trace atoms per point.
struct TubeDetail {
    int steps, sides;
    std::size_t atoms;
};
constexpr TubeDetail kDetails[] = {{4, 8, 1}, {3, 6, 1}, {2, 6, 1}, {2, 5, 1}, {1, 5, 1}, {1, 4, 1},
                                   {1, 3, 1}, {1, 4, 2}, {1, 3, 2}, {1, 3, 3}, {1, 3, 4}};

struct Strand {
    std::vector<Vector3f> point_a;
    std::vector<Rgb8> colour;  // of each point
};

void add_strand(TubeMesh& mesh, const Strand& strand, int steps, int sides, float radius_a) {
    std::vector<Vector3f> curve;
    for (std::size_t i = 0; i + 1 < strand.point_a.size(); ++i)
        for (int s = 0; s < steps; ++s)
            curve.push_back(
                catmull_rom(strand.point_a, i, static_cast<float>(s) / static_cast<float>(steps)));
    curve.push_back(strand.point_a.back());

    // Parallel transport keeps the rings from twisting.
    Vector3f u = Vector3f::Zero();
    std::uint32_t previous = 0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        Vector3f along = curve[std::min(i + 1, curve.size() - 1)] - curve[i > 0 ? i - 1 : 0];
        along = along.norm() > 1e-6F ? along.normalized() : Vector3f::UnitZ();
        u -= along * along.dot(u);
        if (u.norm() < 1e-3F) u = along.unitOrthogonal();
        u.normalize();
        const auto ring = static_cast<std::uint32_t>(mesh.vertex.size());
        const auto steps_per_point = static_cast<std::size_t>(steps);
        const Rgb8& colour = strand.colour[(i + steps_per_point / 2) / steps_per_point];
        add_ring(mesh, curve[i], radius_a * u, radius_a * along.cross(u), sides, colour);
        if (i > 0) join_rings(mesh, previous, ring, sides);
        if (i == 0) close_end(mesh, curve[i] - 0.6F * radius_a * along, -along, ring, sides, false, colour);
        if (i + 1 == curve.size())
            close_end(mesh, curve[i] + 0.6F * radius_a * along, along, ring, sides, true, colour);
        previous = ring;
    }
}

}  // namespace

Vector3f point_a(const Structure& s, std::size_t i) {
    return Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]) / static_cast<float>(kAngstromM);
}

Vector3f catmull_rom(const std::vector<Vector3f>& p, std::size_t i, float t) {
    const Vector3f& b = p[i];
    const Vector3f& c = p[i + 1];
    const Vector3f a = i > 0 ? p[i - 1] : Vector3f(2.0F * b - c);
    const Vector3f d = i + 2 < p.size() ? p[i + 2] : Vector3f(2.0F * c - b);
    return 0.5F * ((2.0F * b) + (c - a) * t + (2.0F * a - 5.0F * b + 4.0F * c - d) * (t * t) +
                   (3.0F * b - a - 3.0F * c + d) * (t * t * t));
}

void add_ring(TubeMesh& mesh, const Vector3f& centre, const Vector3f& u, const Vector3f& v, int sides,
              const Rgb8& colour) {
    const Vector3f along_u = u / u.squaredNorm(), along_v = v / v.squaredNorm();
    for (int k = 0; k < sides; ++k) {
        const float angle =
            2.0F * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(sides);
        const Vector3f p = centre + std::cos(angle) * u + std::sin(angle) * v;
        const Vector3f n = (std::cos(angle) * along_u + std::sin(angle) * along_v).normalized();
        mesh.vertex.push_back(
            {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {colour[0], colour[1], colour[2], 255}});
    }
}

void join_rings(TubeMesh& mesh, std::uint32_t a, std::uint32_t b, int sides) {
    for (int k = 0; k < sides; ++k) {
        const auto i = static_cast<std::uint32_t>(k);
        const auto j = static_cast<std::uint32_t>((k + 1) % sides);
        mesh.index.insert(mesh.index.end(), {a + i, a + j, b + i, a + j, b + j, b + i});
    }
}

void close_end(TubeMesh& mesh, const Vector3f& tip, const Vector3f& normal, std::uint32_t ring, int sides,
               bool last, const Rgb8& colour) {
    const auto centre = static_cast<std::uint32_t>(mesh.vertex.size());
    mesh.vertex.push_back({{tip.x(), tip.y(), tip.z()},
                           {normal.x(), normal.y(), normal.z()},
                           {colour[0], colour[1], colour[2], 255}});
    for (int k = 0; k < sides; ++k) {
        const auto i = ring + static_cast<std::uint32_t>(k);
        const auto j = ring + static_cast<std::uint32_t>((k + 1) % sides);
        if (last)
            mesh.index.insert(mesh.index.end(), {i, j, centre});
        else
            mesh.index.insert(mesh.index.end(), {j, i, centre});
    }
}

std::vector<std::vector<std::uint32_t>> strands_of(const Structure& s) {
    std::vector<std::vector<std::uint32_t>> strands;
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        if (s.trace[i] == 0) continue;
        const bool follows = !strands.empty() && s.chain[i] == s.chain[strands.back().back()] &&
                             (point_a(s, i) - point_a(s, strands.back().back())).norm() <
                                 static_cast<float>(kTraceGapM / kAngstromM);
        if (!follows) strands.emplace_back();
        strands.back().push_back(i);
    }
    std::erase_if(strands, [](const auto& strand) { return strand.size() < 2; });
    return strands;
}

std::vector<Vector3f> thinned_strand_a(const Structure& s, const std::vector<std::uint32_t>& atoms,
                                       std::size_t atoms_per_point) {
    std::vector<Vector3f> points;
    if (atoms_per_point > 1) points.push_back(point_a(s, atoms.front()));
    for (std::size_t i = 0; i < atoms.size(); i += atoms_per_point) {
        Vector3f sum = Vector3f::Zero();
        const std::size_t end = std::min(i + atoms_per_point, atoms.size());
        for (std::size_t k = i; k < end; ++k) sum += point_a(s, atoms[k]);
        points.push_back(sum / static_cast<float>(end - i));
    }
    if (atoms_per_point > 1) points.push_back(point_a(s, atoms.back()));
    return points;
}

TubeMesh build_tubes(const Structure& structure, std::size_t vertices_max, std::span<const Rgb8> paint) {
    const auto strands = strands_of(structure);
    std::size_t points = 0;
    for (const auto& atoms : strands) points += atoms.size();
    TubeDetail detail{};
    for (const TubeDetail& wanted : kDetails) {
        detail = wanted;
        if (points * static_cast<std::size_t>(wanted.steps * wanted.sides) <= vertices_max * wanted.atoms)
            break;
    }
    TubeMesh mesh;
    mesh.strands = strands.size();
    for (const auto& atoms : strands) {
        Strand strand{thinned_strand_a(structure, atoms, detail.atoms), {}};
        const std::size_t count = strand.point_a.size();
        for (std::size_t point = 0; point < count; ++point)
            strand.colour.push_back(paint.empty() ? chain_colour(structure.chain[atoms.front()])
                                                  : paint[atoms[point * atoms.size() / count]]);
        add_strand(mesh, strand, detail.steps, detail.sides, 0.75F);
    }
    return mesh;
}

}  // namespace tact
