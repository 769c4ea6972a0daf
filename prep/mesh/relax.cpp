// Each round finds the nearest point of every sample, starting from the vertex that represents its original vertex.
// Then conjugate gradients solve one linear least-squares problem for the displacements of all vertices:
//
//   sum_s w_s (n_s . (b_1 d_1 + b_2 d_2 + b_3 d_3) - n_s . e_s)^2  +  mu sum_v a_v |d_v|^2
//
// with the sample's normal n_s, its barycentric coordinates b and its offset e_s. Border edges are sampled too and
// attract the border perpendicular to their own direction.
//
// Nothing in the sum prevents a vertex from sliding along the surface; over many rounds this brings the gain. To keep
// vertices on the surface, each may move no farther from the original than it was, or than the typical offset.
#include "prep/mesh/relax.hpp"

#include <algorithm>

#include "prep/mesh/relaxer.hpp"

namespace tact {
namespace {

constexpr int kSolverSteps = 12;
constexpr double kStay = 0.02;             // mu
constexpr std::uint32_t kRoundsMost = 40;  // by default
constexpr std::size_t kPullsMost = 60000;
constexpr std::size_t kHeldMost = 200000;  // triangles of the original

}  // namespace

std::vector<Relaxer::Vec> Relaxer::solve() {
    const std::size_t n = at_.size();
    std::vector<double> stay(n, 0.0);
    std::vector<Vec> x(n, Vec::Zero()), r(n, Vec::Zero()), p, q(n);
    for (const Row& row : row_) {
        for (std::size_t i = 0; i < 3; ++i) {
            stay[row.corner[i]] += kStay * row.weight * row.part[i];
            r[row.corner[i]] += row.weight * row.part[i] * row.offset * row.normal;
        }
    }
    // Preconditioner: the weight of each vertex, which differs with the size of its triangles.
    const auto scaled = [&](const std::vector<Vec>& from) {
        std::vector<Vec> to(n);
        for (std::size_t v = 0; v < n; ++v) to[v] = stay[v] > 0.0 ? Vec(from[v] / stay[v]) : Vec(Vec::Zero());
        return to;
    };
    const auto dot = [&](const std::vector<Vec>& a, const std::vector<Vec>& b) {
        double sum = 0.0;
        for (std::size_t v = 0; v < n; ++v) sum += a[v].dot(b[v]);
        return sum;
    };
    std::vector<Vec> z = scaled(r);
    p = z;
    double rz = dot(r, z);
    for (int step = 0; step < kSolverSteps && rz > 0.0; ++step) {
        for (std::size_t v = 0; v < n; ++v) q[v] = stay[v] * p[v];
        for (const Row& row : row_) {
            double along = 0.0;
            for (std::size_t i = 0; i < 3; ++i) along += row.part[i] * row.normal.dot(p[row.corner[i]]);
            const Vec back = row.weight * along * row.normal;
            for (std::size_t i = 0; i < 3; ++i) q[row.corner[i]] += row.part[i] * back;
        }
        const double curve = dot(p, q);
        if (!(curve > 0.0)) break;
        const double length = rz / curve;
        for (std::size_t v = 0; v < n; ++v) {
            x[v] += length * p[v];
            r[v] -= length * q[v];
        }
        z = scaled(r);
        const double next = dot(r, z);
        for (std::size_t v = 0; v < n; ++v) p[v] = z[v] + next / rz * p[v];
        rz = next;
    }
    return x;
}
void Relaxer::round() {
    row_.clear();
    for (Sample& sample : sample_) {
        if (sample.border)
            pull_border(sample);
        else
            pull(sample);
    }
    set_limits();
    std::vector<Vec> shift = solve();
    if (!grid_) shorten(shift);
    for (std::uint32_t v = 0; v < at_.size(); ++v) {
        if (shift[v].allFinite() && !move(v, at_[v] + shift[v])) move(v, at_[v] + 0.3 * shift[v]);
    }
}

void Relaxer::store() {
    for (std::size_t v = 0; v < at_.size(); ++v) {
        for (std::size_t i = 0; i < 3; ++i)
            simplified_.mesh.position_m[3 * v + i] = static_cast<float>(at_[v][static_cast<Eigen::Index>(i)]);
    }
}
std::uint32_t relax_rounds(const TriangleMesh& original, const Simplified& simplified) {
    const MeshStars star(simplified.mesh);
    const auto border = static_cast<std::size_t>(
        std::count_if(star.border().begin(), star.border().end(), [](auto n) { return n != kNoIndex; }));
    if (border == 0 || original.triangles() > kHeldMost) return 1;
    const std::size_t pulls =
        std::min(original.triangles(), Relaxer::kSamplesPerVertex * simplified.mesh.vertices()) +
        border * border / 16;
    return static_cast<std::uint32_t>(
        std::clamp<std::size_t>(kPullsMost / std::max<std::size_t>(pulls, 1), 1, kRoundsMost));
}

void relax(const TriangleMesh& original, Simplified& simplified, std::uint32_t rounds,
           const Progress& progress) {
    if (rounds == 0 || simplified.mesh.triangles() == 0) return;
    Relaxer relaxer(original, simplified);
    if (rounds > 1 && original.triangles() <= kHeldMost) relaxer.hold();
    for (std::uint32_t i = 0; i < rounds; ++i) {
        report(progress, static_cast<double>(i) / rounds, "simplify: moving vertices towards the original");
        relaxer.round();
    }
    relaxer.store();
}

}  // namespace tact
