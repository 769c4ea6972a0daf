#include "tests/reproduce/mesh_error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ipc/base/pose.hpp"

namespace tact::launch {
namespace {

Vec3 vertex(const TriangleMesh& mesh, std::size_t v) {
    return {static_cast<double>(mesh.position_m[3 * v]), static_cast<double>(mesh.position_m[3 * v + 1]),
            static_cast<double>(mesh.position_m[3 * v + 2])};
}

double to_segment2(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
    return (p - a - t * ab).squaredNorm();
}

// Squared distance to a triangle: to its plane if p projects into the triangle, otherwise to the nearest edge.
double to_triangle2(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a);
    const bool over = n.dot((b - a).cross(p - a)) >= 0.0 && n.dot((c - b).cross(p - b)) >= 0.0 &&
                      n.dot((a - c).cross(p - c)) >= 0.0;
    const double n2 = n.squaredNorm();
    if (over && n2 > 0.0) return std::pow(n.dot(p - a), 2) / n2;
    return std::min({to_segment2(p, a, b), to_segment2(p, b, c), to_segment2(p, c, a)});
}

// Triangles with bounding spheres, which exclude most triangles without an exact test.
class Surface {
public:
    explicit Surface(const TriangleMesh& mesh) {
        for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
            Triangle s{vertex(mesh, mesh.triangle[t]), vertex(mesh, mesh.triangle[t + 1]),
                       vertex(mesh, mesh.triangle[t + 2]), Vec3::Zero(), 0.0};
            s.middle = (s.a + s.b + s.c) / 3.0;
            s.radius = std::sqrt(std::max({(s.a - s.middle).squaredNorm(), (s.b - s.middle).squaredNorm(),
                                           (s.c - s.middle).squaredNorm()}));
            all_.push_back(s);
        }
    }
    [[nodiscard]] double distance2(const Vec3& p) const {
        double best = 1e300, reach = 1e150;
        for (const Triangle& t : all_) {
            const double far = t.radius + reach;
            if ((p - t.middle).squaredNorm() >= far * far) continue;
            const double d2 = to_triangle2(p, t.a, t.b, t.c);
            if (d2 >= best) continue;
            best = d2;
            reach = std::sqrt(d2);
        }
        return best;
    }

private:
    struct Triangle {
        Vec3 a, b, c, middle;
        double radius;
    };
    std::vector<Triangle> all_;
};

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Edge> border(const TriangleMesh& mesh) {
    std::map<Edge, int> times;
    for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.triangle[t + i], b = mesh.triangle[t + (i + 1) % 3];
            ++times[std::minmax(a, b)];
        }
    std::vector<Edge> edges;
    for (const auto& [edge, n] : times)
        if (n == 1) edges.push_back(edge);
    return edges;
}

}  // namespace

MeshError mesh_error(const TriangleMesh& original, const TriangleMesh& simplified) {
    MeshError e;
    const Surface to_simplified(simplified), to_original(original);
    Vec3 low = Vec3::Constant(1e300), high = -low;
    double sum = 0.0;
    for (std::size_t v = 0; v < original.vertices(); ++v) {
        const Vec3 p = vertex(original, v);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
        const double d2 = to_simplified.distance2(p);
        sum += d2;
        e.max_m = std::max(e.max_m, std::sqrt(d2));
    }
    if (original.vertices() == 0) return e;
    e.rms_m = std::sqrt(sum / static_cast<double>(original.vertices()));
    e.diagonal_m = (high - low).norm();
    for (std::size_t v = 0; v < simplified.vertices(); ++v)
        e.back_max_m = std::max(e.back_max_m, std::sqrt(to_original.distance2(vertex(simplified, v))));
    const std::vector<Edge> kept = border(simplified);
    for (const Edge& edge : border(original))
        for (const std::uint32_t end : {edge.first, edge.second}) {
            double best = kept.empty() ? 0.0 : 1e300;
            const Vec3 p = vertex(original, end);
            for (const Edge& k : kept)
                best =
                    std::min(best, to_segment2(p, vertex(simplified, k.first), vertex(simplified, k.second)));
            e.border_max_m = std::max(e.border_max_m, std::sqrt(best));
        }
    return e;
}

}  // namespace tact::launch
