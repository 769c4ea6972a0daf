// Which moves of a vertex a Relaxer refuses, and how far one may go.
#include <algorithm>
#include <cmath>

#include "prep/mesh/relaxer.hpp"

namespace tact {
namespace {

constexpr double kStray = 16.0;          // times the mean squared offset
constexpr double kOpposedOffset = 0.25;  // times the root of the mean squared offset
constexpr double kShiftMost = 2.0;       // times the largest offset at a vertex, in a single round
constexpr double kStartCosine = 0.3;     // a triangle may turn by 72 degrees over all rounds

}  // namespace

// A coarse grid, because there are few queries.
void Relaxer::hold() { grid_.emplace(original_, 64.0); }
// Squared distance.
double Relaxer::from_border(const Vec& p) const {
    double best = 1e300;
    for (const auto& [a, b] : border_) {
        const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        best = std::min(best, (p - a - s * (b - a)).squaredNorm());
    }
    return best;
}

void Relaxer::set_limits() {
    if (grid_ && stray_.empty()) limit_stray();
    double sum = 0.0, weight = 0.0;
    for (const Row& row : row_) {
        if (row.on_border()) continue;
        sum += row.weight * row.offset * row.offset;
        weight += row.weight;
    }
    opposed_limit_m_ = kOpposedOffset * std::sqrt(sum / std::max(weight, 1e-300));
}

void Relaxer::limit_stray() {
    double surface = 0.0, border = 0.0, surface_weight = 0.0, border_weight = 0.0;
    for (const Row& row : row_) {
        (row.on_border() ? border : surface) += row.weight * row.offset * row.offset;
        // Border samples have two rows.
        (row.on_border() ? border_weight : surface_weight) += row.on_border() ? 0.5 * row.weight : row.weight;
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

}  // namespace tact
