#include "prep/synthetic/made_tool.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kSides = 24;
constexpr double kMm = 1e-3;

struct ToolRing {
    Vec3 at_mm;
    double radius_mm;
};

void put_vertex(TriangleMesh& mesh, const Vec3& p_m) {
    for (const double x : {p_m.x(), p_m.y(), p_m.z()}) mesh.position_m.push_back(static_cast<float>(x));
}

// A tube through rings whose centre line lies in the plane z = 0, closed at both ends.
TriangleMesh swept(const std::vector<ToolRing>& rings) {
    TriangleMesh mesh;
    const auto count = static_cast<std::uint32_t>(rings.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 along =
            (rings[std::min(i + 1, count - 1)].at_mm - rings[i > 0 ? i - 1 : 0].at_mm).normalized();
        const Vec3 side = along.cross(Vec3::UnitZ());
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const double a = 2.0 * std::numbers::pi * k / kSides;
            put_vertex(mesh, kMm * (rings[i].at_mm +
                                    rings[i].radius_mm * (std::cos(a) * side + std::sin(a) * Vec3::UnitZ())));
        }
    }
    const auto at = [](std::uint32_t ring, std::uint32_t k) { return ring * kSides + k % kSides; };
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const std::uint32_t a = at(i, k), b = at(i, k + 1), c = at(i + 1, k), d = at(i + 1, k + 1);
            mesh.triangle.insert(mesh.triangle.end(), {a, d, b, a, c, d});
        }
    }
    const auto cap = [&](std::uint32_t ring, bool last) {
        const auto middle = static_cast<std::uint32_t>(mesh.vertices());
        put_vertex(mesh, kMm * rings[ring].at_mm);
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const std::uint32_t a = at(ring, k + (last ? 1 : 0)), b = at(ring, k + (last ? 0 : 1));
            mesh.triangle.insert(mesh.triangle.end(), {middle, a, b});
        }
    };
    cap(0, false);
    cap(count - 1, true);
    return mesh;
}

TriangleMesh scaler() {
    std::vector<ToolRing> rings;
    for (const auto& [y, r] : {std::pair(45.0, 2.0), {44.0, 3.0}, {12.0, 3.0}, {6.0, 2.4}, {0.0, 1.3}})
        rings.push_back({{0.0, y, 0.0}, r});
    for (int i = 1; i <= 6; ++i)  // downwards and slightly aside
        rings.push_back({{0.5 * i, -1.5 * i, 0.0}, 1.3 - 0.08 * i});
    // The tip: an arc of 100 degrees that bends back below the handle and tapers.
    const Vec3 from(3.0, -9.0, 0.0);
    constexpr int kArc = 16;
    for (int i = 1; i <= kArc; ++i) {
        const double s = static_cast<double>(i) / kArc, a = s * 100.0 * std::numbers::pi / 180.0;
        // A circle of 4 mm around a point to the left, starting downwards.
        rings.push_back({from + 4.0 * Vec3(std::cos(a) - 1.0, -std::sin(a), 0.0), 0.82 - 0.6 * s});
    }
    return swept(rings);
}

TriangleMesh block() {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        put_vertex(mesh, kMm * Vec3((i & 1) != 0 ? 8.0 : -8.0, (i & 2) != 0 ? 4.0 : -4.0,
                                    (i & 4) != 0 ? 6.0 : -6.0));
    mesh.triangle = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

}  // namespace

TriangleMesh made_tool(const std::string& name) {
    if (name == "scaler") return scaler();
    if (name == "block") return block();
    return {};
}

}  // namespace tact
