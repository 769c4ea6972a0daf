#include "prep/surface/sample_tool.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "prep/mesh/simplify.hpp"
#include "prep/surface/build_surface.hpp"

namespace tact {
namespace {

constexpr std::size_t kCandidatesEach = 16, kCandidatesLeast = 8192;
constexpr double kDeepest = 2.0;  // maximum depth of a ball below a corner, in radii

// Weights of the squared distance from a candidate to all earlier points: a ball that sticks out beside an edge is
// taken late, a sharp corner early.
constexpr double kSticksOut = 0.25, kCorner = 2.25;
constexpr double kSharp = 0.9;  // cosine between a corner's normal and that of a facet

struct Candidates {
    std::vector<Vec3> place_m, inward;  // inward * ball radius is the way to the ball's centre
    std::vector<double> counts;
};

class ToolMesh {
public:
    explicit ToolMesh(const TriangleMesh& mesh) : mesh_(mesh), summed_(mesh.triangles()) {
        double sum = 0.0;
        for (std::uint32_t t = 0; t < summed_.size(); ++t) {
            const double area = 0.5 * doubled(t).norm();
            middle_m_ += area * (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
            summed_[t] = sum += area;
        }
        if (!(sum > 0.0) || !std::isfinite(sum))
            throw StartupError("sample a tool", "the surface of the tool has no area",
                               "check the tool's mesh and unit");
        middle_m_ /= sum;
    }
    [[nodiscard]] const Vec3& middle_m() const { return middle_m_; }

    void spread(std::size_t count, Candidates& out) const {
        // Strata of equal area, and a lattice of points within each triangle (Roberts' R2).
        for (std::size_t i = 0; i < count; ++i) {
            const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * summed_.back();
            const auto t = static_cast<std::uint32_t>(std::min<std::size_t>(
                static_cast<std::size_t>(std::lower_bound(summed_.begin(), summed_.end(), at) -
                                         summed_.begin()),
                summed_.size() - 1));
            const double n = static_cast<double>(i) + 1.0;
            double a = std::fmod(0.7548776662466927 * n, 1.0), b = std::fmod(0.5698402909980532 * n, 1.0);
            if (a + b > 1.0) {
                a = 1.0 - a;
                b = 1.0 - b;
            }
            const Vec3 p = corner(t, 0);
            out.place_m.push_back(p + a * (corner(t, 1) - p) + b * (corner(t, 2) - p));
            out.inward.push_back(-doubled(t).normalized());
            out.counts.push_back(1.0);
        }
    }
    void vertices(std::size_t count_max, Candidates& out) const {
        const std::size_t every = mesh_.vertices() / std::max<std::size_t>(count_max, 1) + 1;
        std::vector<Vec3> mean(mesh_.vertices(), Vec3::Zero());
        // Weighted by angle, so that the result does not depend on the triangulation of the sides.
        for (std::uint32_t t = 0; t < mesh_.triangles(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const Vec3 a = corner(t, (k + 1) % 3) - corner(t, k),
                           b = corner(t, (k + 2) % 3) - corner(t, k);
                mean[vertex(t, k)] += std::atan2(a.cross(b).norm(), a.dot(b)) * doubled(t).normalized();
            }
        }
        // Smallest cosine between the mean normal and the facets at a vertex.
        std::vector<double> least(mesh_.vertices(), 1.0);
        for (std::uint32_t t = 0; t < mesh_.triangles(); ++t) {
            const Vec3 facet = doubled(t).normalized();
            for (int k = 0; k < 3; ++k) {
                double& l = least[vertex(t, k)];
                l = std::min(l, facet.dot(mean[vertex(t, k)].normalized()));
            }
        }
        for (std::size_t v = 0; v < mesh_.vertices(); v += every) {
            if (!(mean[v].norm() > 0.0)) continue;
            out.place_m.push_back(position_m(v));
            out.inward.push_back(-mean[v].normalized() / std::max(least[v], 1.0 / kDeepest));
            out.counts.push_back(least[v] < kSharp ? kCorner : 1.0);
        }
    }

private:
    [[nodiscard]] Vec3 position_m(std::size_t v) const {
        const float* const p = mesh_.position_m.data() + 3 * v;
        return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
    [[nodiscard]] std::uint32_t vertex(std::uint32_t t, int k) const {
        return mesh_.triangle[std::size_t{3} * t + static_cast<std::size_t>(k)];
    }
    [[nodiscard]] Vec3 corner(std::uint32_t t, int k) const { return position_m(vertex(t, k)); }
    [[nodiscard]] Vec3 doubled(std::uint32_t t) const {  // facet normal of twice the area in length
        return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    }
    const TriangleMesh& mesh_;
    std::vector<double> summed_;
    Vec3 middle_m_ = Vec3::Zero();
};

void mark_sticking_out(const TriangleMesh& mesh, const Vec3& hand_m, double ball_m, std::size_t corners,
                       Candidates& candidates) {
    SceneWriter out;
    write_surface(out, build_surface(mesh));
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "the tool");
    const SurfaceMesh surface = read_surface(file);
    for (std::size_t c = corners; c < candidates.place_m.size(); ++c) {
        const Vec3 centre = candidates.place_m[c] + ball_m * candidates.inward[c] + hand_m;
        if (surface.nearest(centre, 0.98 * ball_m).triangle != SurfacePoint::kNone)
            candidates.counts[c] = kSticksOut;
    }
}

// Farthest-point sampling: stores the candidates in the order taken, with parents and covers.
void take_farthest(const Candidates& from, std::uint32_t points, std::size_t next, TouchTool& tool,
                   std::vector<std::uint32_t>& taken, const Progress& progress) {
    const std::size_t count = from.place_m.size();
    std::vector<double> square(count, 1e300);
    std::vector<std::uint32_t> nearest(count, 0);
    const double least = 1e-9 * from.place_m[next].norm();
    while (taken.size() < points) {
        if (taken.size() % 256 == 0)
            report(progress, static_cast<double>(taken.size()) / points, "sampling the tool");
        const auto number = static_cast<std::uint32_t>(taken.size());
        tool.parent.push_back(number == 0 ? 0 : nearest[next]);
        taken.push_back(static_cast<std::uint32_t>(next));
        const Vec3 place = from.place_m[next];
        double farthest = -1.0, wanted = -1.0;
        for (std::size_t c = 0; c < count; ++c) {
            const double s = (from.place_m[c] - place).squaredNorm();
            if (s < square[c]) {
                square[c] = s;
                nearest[c] = number;
            }
            farthest = std::max(farthest, square[c]);
            if (from.counts[c] * square[c] > wanted) {
                wanted = from.counts[c] * square[c];
                next = c;
            }
        }
        const double cover = std::sqrt(farthest);
        tool.cover_m.push_back(static_cast<float>(cover));
        if (!(cover > least)) break;  // all candidates are taken
    }
}

}  // namespace

TouchTool sample_tool(TriangleMesh mesh, const ToolSampling& sampling, const Progress& progress) {
    TouchTool tool;
    const std::uint32_t points = std::clamp<std::uint32_t>(sampling.points, 1, TouchTool::kPointsMax);
    const ToolMesh surface(mesh);
    const Vec3 hand_m = sampling.grip_in_middle ? surface.middle_m() : Vec3(Vec3::Zero());
    Candidates candidates;
    const std::size_t spread = std::max(kCandidatesEach * points, kCandidatesLeast);
    surface.vertices(spread, candidates);
    const std::size_t corners = candidates.place_m.size();
    surface.spread(spread, candidates);
    std::size_t start = 0;
    double reach_m = 0.0;
    for (std::size_t c = 0; c < candidates.place_m.size(); ++c) {
        candidates.place_m[c] -= hand_m;
        if (candidates.place_m[c].norm() <= reach_m) continue;
        reach_m = candidates.place_m[c].norm();
        start = c;
    }
    tool.ball_m = sampling.ball_share * reach_m;
    if (!(tool.ball_m > 0.0) || !(reach_m < 1e6))
        throw StartupError("sample a tool",
                           "the tool reaches " + std::to_string(reach_m) + " m from the grip point",
                           "check the tool's mesh and unit");
    mark_sticking_out(mesh, hand_m, tool.ball_m, corners, candidates);
    std::vector<std::uint32_t> taken;
    take_farthest(candidates, points, start, tool, taken, progress);
    for (const std::uint32_t c : taken) {
        const Vec3 centre = candidates.place_m[c] + tool.ball_m * candidates.inward[c];
        for (const double x : {centre.x(), centre.y(), centre.z()})
            tool.point_m.push_back(static_cast<float>(x));
        tool.normal.push_back(oct_normal(-candidates.inward[c].normalized()));
    }
    const std::uint32_t drawn = std::min(sampling.drawn_triangles, TouchTool::kDrawnMax);
    if (mesh.triangles() > drawn || mesh.vertices() > TouchTool::kDrawnMax) {
        SimplifySettings settings;
        settings.vertices_min = drawn / 2;
        mesh = simplify(mesh, settings, progress).mesh;
        // A mesh that cannot be contracted this far (a soup of single triangles) is drawn in part.
        if (mesh.triangles() > TouchTool::kDrawnMax)
            mesh.triangle.resize(3 * std::size_t{TouchTool::kDrawnMax});
        if (mesh.vertices() > TouchTool::kDrawnMax) mesh = {};
    }
    tool.drawn_m = std::move(mesh.position_m);
    for (std::size_t i = 0; i < tool.drawn_m.size(); ++i)
        tool.drawn_m[i] -= static_cast<float>(hand_m[static_cast<Eigen::Index>(i % 3)]);
    tool.drawn = std::move(mesh.triangle);
    return tool;
}

}  // namespace tact
