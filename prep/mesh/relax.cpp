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

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "prep/mesh/mesh_distance.hpp"
#include "prep/mesh/mesh_stars.hpp"
#include "prep/mesh/nearest_point.hpp"
#include "prep/mesh/opposed.hpp"
#include "prep/mesh/turn_limits.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kSamplesPerVertex = 20;
constexpr int kSolverSteps = 12;
constexpr double kStay = 0.02;  // mu
constexpr double kBorderWeight = 6.0;
constexpr double kStray = 16.0;            // times the mean squared offset
constexpr double kOpposedOffset = 0.25;    // times the root of the mean squared offset
constexpr double kShiftMost = 2.0;         // times the largest offset at a vertex, in a single round
constexpr double kStartCosine = 0.3;       // a triangle may turn by 72 degrees over all rounds
constexpr std::uint32_t kRoundsMost = 40;  // by default
constexpr std::size_t kPullsMost = 60000;
constexpr std::size_t kHeldMost = 200000;  // triangles of the original

using Vec = Eigen::Vector3d;
using Corners = std::array<std::uint32_t, 3>;

struct Sample {
    Vec at, normal;  // on a border: direction of the edge
    double weight;
    std::uint32_t near;  // vertex where the search starts
    bool border;
};
struct Row {
    Corners corner;
    std::array<double, 3> part;
    Vec normal;
    double weight, offset;
};

class Relaxer {
public:
    Relaxer(const TriangleMesh& original, Simplified& simplified);
    void hold();
    void round();
    void store();

private:
    void take_sides();
    void take_samples();
    void take_border_samples();
    void pull(Sample& sample);
    void pull_border(Sample& sample);
    [[nodiscard]] Vec original(std::uint32_t v) const {
        return {original_.position_m[3 * std::size_t{v}], original_.position_m[3 * std::size_t{v} + 1],
                original_.position_m[3 * std::size_t{v} + 2]};
    }
    std::vector<Vec> solve();
    void limit_stray();
    void set_opposed_limit();
    void shorten(std::vector<Vec>& shift) const;
    [[nodiscard]] double from_border(const Vec& p) const;
    [[nodiscard]] double from_original(std::uint32_t v, const Vec& p) const {
        return star_.border()[v] != kNoIndex ? from_border(p) : grid_->squared(p);
    }
    bool move(std::uint32_t v, const Vec& to);
    bool opposes(std::uint32_t v, const Vec& from);
    [[nodiscard]] Vec double_area(const Corners& c) const {
        return (at_[c[1]] - at_[c[0]]).cross(at_[c[2]] - at_[c[0]]);
    }

    const TriangleMesh& original_;
    Simplified& simplified_;
    std::vector<std::uint32_t> went_;  // original vertex -> vertex of the simplified mesh
    std::vector<Vec> at_;
    std::vector<Corners> triangle_;
    std::vector<Vec> start_;  // normals before the first round
    MeshStars star_;
    std::vector<Sample> sample_;
    std::vector<Row> row_;
    std::vector<Side<double>> side_;  // per vertex
    std::vector<Vec> facing_;         // per vertex: sum of the double areas that it represents
    Opposed opposed_;
    double opposed_limit_m_ = 0.0;
    std::vector<std::array<Vec, 2>> border_;  // border edges of the original
    std::optional<MeshGrid> grid_;            // of the original, if vertices must stay near it
    std::vector<double> stray_;               // per vertex: allowed squared distance from the original
};

std::vector<Corners> corners(const TriangleMesh& mesh) {
    std::vector<Corners> out(mesh.triangles());
    for (std::size_t t = 0; t < out.size(); ++t)
        out[t] = {mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
    return out;
}

Relaxer::Relaxer(const TriangleMesh& original, Simplified& simplified)
    : original_(original),
      simplified_(simplified),
      triangle_(corners(simplified.mesh)),
      star_(simplified.mesh),
      opposed_(original) {
    for (const Contraction& c : simplified.contraction) opposed_.join(c.kept, c.gone);
    went_.assign(original.vertices(), kNoIndex);
    for (std::uint32_t v = 0; v < simplified.origin.size(); ++v) went_[simplified.origin[v]] = v;
    for (std::size_t i = simplified.contraction.size(); i-- > 0;)
        went_[simplified.contraction[i].gone] = went_[simplified.contraction[i].kept];
    for (std::size_t v = 0; v < simplified.mesh.vertices(); ++v) {
        const float* p = &simplified.mesh.position_m[3 * v];
        at_.emplace_back(p[0], p[1], p[2]);
    }
    for (const Corners& c : triangle_) start_.push_back(double_area(c));
    take_sides();
    take_samples();
    take_border_samples();
}

// A coarse grid, because there are few queries.
void Relaxer::hold() { grid_.emplace(original_, 64.0); }

void Relaxer::take_sides() {
    facing_.assign(at_.size(), Vec::Zero());
    std::vector<double> area(at_.size(), 0.0);
    for (std::size_t t = 0; t < original_.triangles(); ++t) {
        const std::uint32_t* c = &original_.triangle[3 * t];
        const Vec normal = (original(c[1]) - original(c[0])).cross(original(c[2]) - original(c[0]));
        for (const std::uint32_t v : {went_[c[0]], went_[c[1]], went_[c[2]]}) {
            if (v == kNoIndex) continue;
            facing_[v] += normal;
            area[v] += normal.norm();
        }
    }
    for (std::size_t v = 0; v < at_.size(); ++v) side_.emplace_back(facing_[v], area[v]);
}

// Samples the centres of triangles, weighted by area; skips triangles if there are more than needed.
void Relaxer::take_samples() {
    const std::size_t most = std::size_t{kSamplesPerVertex} * at_.size();
    const std::size_t stride =
        std::max<std::size_t>(1, original_.triangles() / std::max<std::size_t>(most, 1));
    for (std::size_t t = 0; t < original_.triangles(); t += stride) {
        const std::uint32_t* c = &original_.triangle[3 * t];
        if (went_[c[0]] == kNoIndex) continue;
        const Vec a = original(c[0]), b = original(c[1]), d = original(c[2]);
        const Vec normal = (b - a).cross(d - a);
        const double area = normal.norm();
        if (area > 0.0) sample_.push_back({(a + b + d) / 3.0, normal / area, area, went_[c[0]], false});
    }
}

void Relaxer::take_border_samples() {
    if (std::none_of(star_.border().begin(), star_.border().end(), [](auto n) { return n != kNoIndex; }))
        return;
    const MeshStars star(original_);
    for (std::uint32_t v = 0; v < original_.vertices(); ++v) {
        const std::uint32_t w = star.border()[v];
        if (w == kNoIndex || went_[v] == kNoIndex) continue;
        const Vec along = original(w) - original(v);
        const double length = along.norm();
        if (!(length > 0.0)) continue;
        border_.push_back({original(v), original(w)});
        sample_.push_back(
            {original(v) + 0.5 * along, along / length, kBorderWeight * length * length, went_[v], true});
    }
}

// Finds the nearest triangle around the vertex where the sample starts, then around that triangle's corners as long as
// the distance decreases.
void Relaxer::pull(Sample& sample) {
    NearestPoint best;
    std::uint32_t triangle = kNoIndex;
    const auto around = [&](std::uint32_t v) {
        for (const std::uint32_t t : star_.triangles(v)) {
            if (t == triangle) continue;
            const Corners& c = triangle_[t];
            const NearestPoint p = nearest_point(sample.at, at_[c[0]], at_[c[1]], at_[c[2]]);
            if (p.square >= best.square) continue;
            best = p;
            triangle = t;
        }
    };
    around(sample.near);
    for (int step = 0; step < 4 && triangle != kNoIndex; ++step) {
        const std::uint32_t from = triangle;
        for (const std::uint32_t v : triangle_[from]) {
            if (v != sample.near) around(v);
        }
        if (triangle == from) break;
    }
    if (triangle == kNoIndex) return;
    const Corners& c = triangle_[triangle];
    const std::size_t largest =
        static_cast<std::size_t>(std::max_element(best.part.begin(), best.part.end()) - best.part.begin());
    sample.near = c[largest];
    const Vec n = double_area(c);
    if (!(n.dot(sample.normal) > 0.2 * n.norm())) return;  // another side of the body, or a removed part
    const Vec foot = best.part[0] * at_[c[0]] + best.part[1] * at_[c[1]] + best.part[2] * at_[c[2]];
    row_.push_back({c, best.part, sample.normal, sample.weight, sample.normal.dot(sample.at - foot)});
}

void Relaxer::pull_border(Sample& sample) {
    double best = 1e300, part = 0.0;
    std::uint32_t from = kNoIndex;
    const auto look = [&](std::uint32_t v) {
        const std::uint32_t w = star_.border()[v];
        if (w == kNoIndex) return;
        const Vec along = at_[w] - at_[v];
        const double square = along.squaredNorm();
        if (!(square > 0.0)) return;
        const double s = std::clamp((sample.at - at_[v]).dot(along) / square, 0.0, 1.0);
        const double distance = (sample.at - at_[v] - s * along).squaredNorm();
        if (distance >= best) return;
        best = distance;
        part = s;
        from = v;
    };
    look(sample.near);
    for (const std::uint32_t t : star_.triangles(sample.near)) {
        for (const std::uint32_t v : triangle_[t]) look(v);
    }
    if (from == kNoIndex) return;
    const std::uint32_t to = star_.border()[from];
    const Vec e = sample.at - (1.0 - part) * at_[from] - part * at_[to];
    const Vec side = sample.normal.unitOrthogonal(), up = sample.normal.cross(side);
    for (const Vec& n : {side, up})
        row_.push_back({{from, to, to}, {1.0 - part, part, 0.0}, n, sample.weight, n.dot(e)});
    sample.near = part < 0.5 ? from : to;
}

std::vector<Vec> Relaxer::solve() {
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

// Squared distance.
double Relaxer::from_border(const Vec& p) const {
    double best = 1e300;
    for (const auto& [a, b] : border_) {
        const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        best = std::min(best, (p - a - s * (b - a)).squaredNorm());
    }
    return best;
}

void Relaxer::limit_stray() {
    double surface = 0.0, border = 0.0, surface_weight = 0.0, border_weight = 0.0;
    for (const Row& row : row_) {
        const bool on_border = row.corner[1] == row.corner[2];  // border samples have two rows
        (on_border ? border : surface) += row.weight * row.offset * row.offset;
        (on_border ? border_weight : surface_weight) += on_border ? 0.5 * row.weight : row.weight;
    }
    surface *= kStray / std::max(surface_weight, 1e-300);
    border *= kStray / std::max(border_weight, 1e-300);
    for (std::uint32_t v = 0; v < at_.size(); ++v)
        stray_.push_back(
            std::max(from_original(v, at_[v]), star_.border()[v] != kNoIndex ? border : surface));
}

// A vertex with few samples could leave the surface by many times what the samples ask for.
void Relaxer::shorten(std::vector<Vec>& shift) const {
    std::vector<double> most(shift.size(), 0.0);
    for (const Row& row : row_) {
        for (const std::uint32_t v : row.corner)
            most[v] = std::max(most[v], kShiftMost * std::abs(row.offset));
    }
    for (std::size_t v = 0; v < shift.size(); ++v) {
        const double length = shift[v].norm();
        if (length > most[v]) shift[v] *= most[v] / length;
    }
}

void Relaxer::set_opposed_limit() {
    double sum = 0.0, weight = 0.0;
    for (const Row& row : row_) {
        if (row.corner[1] == row.corner[2]) continue;  // of a border
        sum += row.weight * row.offset * row.offset;
        weight += row.weight;
    }
    opposed_limit_m_ = kOpposedOffset * std::sqrt(sum / std::max(weight, 1e-300));
}

// Returns false and changes nothing if a triangle would flip or two would fold onto each other.
bool Relaxer::move(std::uint32_t v, const Vec& to) {
    const Vec from = at_[v];
    if (grid_ && from_original(v, to) > stray_[v]) return false;
    std::vector<std::pair<Vec, std::uint32_t>> before;
    for (const std::uint32_t t : star_.triangles(v)) before.push_back({double_area(triangle_[t]), t});
    at_[v] = to;
    const auto refuse = [&] {
        at_[v] = from;
        return false;
    };
    for (const auto& [was, t] : before) {
        const Vec now = double_area(triangle_[t]);
        if (!(was.dot(now) > kTurnCosine<double> * was.norm() * now.norm()) || now.norm() < 0.1 * was.norm())
            return refuse();
        if (now.dot(start_[t]) < kStartCosine * now.norm() * start_[t].norm()) return refuse();
        for (const std::uint32_t w : triangle_[t])
            if (side_[w].left_by(was, was.norm(), now, now.norm())) return refuse();
    }
    for (const auto& [was, t] : before) {
        const Vec now = double_area(triangle_[t]);
        for (const std::uint32_t w : triangle_[t]) {
            for (const std::uint32_t other : star_.triangles(w)) {
                if (other == t || !star_.share_edge(t, other)) continue;
                const Vec n = double_area(triangle_[other]);
                if (now.dot(n) < kFoldCosine<double> * now.norm() * n.norm()) return refuse();
            }
        }
    }
    return !opposes(v, from) || refuse();
}

// True if a triangle faces away from the original by more than the limit, and by more than before v was moved.
bool Relaxer::opposes(std::uint32_t v, const Vec& from) {
    for (const std::uint32_t t : star_.triangles(v)) {
        const Corners& c = triangle_[t];
        const Vec normal = double_area(c);
        if (std::none_of(c.begin(), c.end(), [&](std::uint32_t w) { return normal.dot(facing_[w]) < 0.0; }))
            continue;
        const std::vector<std::uint32_t>& origin = simplified_.origin;
        Opposed::Face face{{origin[c[0]], origin[c[1]], origin[c[2]]}, {at_[c[0]], at_[c[1]], at_[c[2]]}};
        const double after = opposed_.opposed_m(face, opposed_limit_m_);
        if (after <= opposed_limit_m_) continue;
        for (std::size_t i = 0; i < 3; ++i)
            if (c[i] == v) face.corner[i] = from;
        if (after > opposed_.opposed_m(face, opposed_limit_m_)) return true;
    }
    return false;
}

void Relaxer::round() {
    row_.clear();
    for (Sample& sample : sample_) {
        if (sample.border)
            pull_border(sample);
        else
            pull(sample);
    }
    if (grid_ && stray_.empty()) limit_stray();
    set_opposed_limit();
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

}  // namespace

std::uint32_t relax_rounds(const TriangleMesh& original, const Simplified& simplified) {
    const MeshStars star(simplified.mesh);
    const auto border = static_cast<std::size_t>(
        std::count_if(star.border().begin(), star.border().end(), [](auto n) { return n != kNoIndex; }));
    if (border == 0 || original.triangles() > kHeldMost) return 1;
    const std::size_t pulls =
        std::min(original.triangles(), kSamplesPerVertex * simplified.mesh.vertices()) + border * border / 16;
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
