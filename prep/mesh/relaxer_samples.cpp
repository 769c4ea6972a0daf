// What a Relaxer is made of: where the original attracts the simplified mesh.
#include <algorithm>

#include "prep/mesh/nearest_point.hpp"
#include "prep/mesh/relaxer.hpp"

namespace tact {
namespace {

constexpr double kBorderWeight = 6.0;

std::vector<std::array<std::uint32_t, 3>> triangles_of(const TriangleMesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> out(mesh.triangles());
    for (std::size_t t = 0; t < out.size(); ++t)
        out[t] = {mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
    return out;
}

}  // namespace

Relaxer::Relaxer(const TriangleMesh& original, Simplified& simplified)
    : original_(original),
      simplified_(simplified),
      triangle_(triangles_of(simplified.mesh)),
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

}  // namespace tact
