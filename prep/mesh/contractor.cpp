#include "prep/mesh/contractor.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::uint32_t kBorder = 1U << 31;
constexpr float kPull = 1e-5F;  // 1e-5 to 1e-2 differ by 3 % in RMS; more displaces corners
constexpr float kVolumeFar = 1.0F;
constexpr float kFar = 2.0F;  // an optimum further than this many pair lengths from the middle is refused
constexpr float kTurnCosine = 0.5F;   // a triangle may turn by 60 degrees in one contraction
constexpr float kFoldCosine = -0.9F;  // and not come nearer than 26 degrees to lying on its neighbour
constexpr float kThin = 1e-3F;
constexpr float kRefusedFactor = 2.0F;  // a refused pair waits until pairs of twice its cost are due
constexpr float kCostMax = 1e6F;

// 4 sqrt(3) area / sum of squared sides: 1 for an equilateral triangle.
float roundness(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float double_area) {
    const float sides = a.squaredNorm() + b.squaredNorm() + (a - b).squaredNorm();
    return sides > 0.0F ? 3.4641016F * double_area / sides : 0.0F;
}

}  // namespace

Contractor::Contractor(const TriangleMesh& mesh, const SimplifySettings& settings) : settings_(settings) {
    scale(mesh);
    touch();
    add_planes();
}

void Contractor::scale(const TriangleMesh& mesh) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        const Eigen::Vector3d p(mesh.position_m[3 * v], mesh.position_m[3 * v + 1],
                                mesh.position_m[3 * v + 2]);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    if (mesh.vertices() > 0) {
        centre_ = 0.5 * (low + high);
        extent_ = std::max((high - low).maxCoeff(), 1e-30);
    }
    vertex_.resize(mesh.vertices());
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        for (std::size_t i = 0; i < 3; ++i) {
            vertex_[v].p[i] = static_cast<float>(
                (mesh.position_m[3 * v + i] - centre_[static_cast<Eigen::Index>(i)]) / extent_);
        }
    }
    triangle_.resize(mesh.triangles());
    for (std::size_t t = 0; t < triangle_.size(); ++t)
        triangle_[t] = {mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
}

void Contractor::touch() {
    for (const Corners& corners : triangle_) {
        for (const std::uint32_t v : corners) ++vertex_[v].count;
    }
    std::uint32_t first = 0;
    for (Vertex& v : vertex_) {
        v.first = first;
        first += v.count;
        if (v.count > 0) ++alive_;
        v.count = 0;
    }
    // Half as much again is filled by appended lists before the live ones are moved together.
    touch_limit_ = first + first / 2;
    touch_.reserve(touch_limit_ + 4096);
    touch_.resize(first);
    for (std::uint32_t t = 0; t < triangle_.size(); ++t) {
        for (const std::uint32_t v : triangle_[t]) touch_[vertex_[v].first + vertex_[v].count++] = t;
    }
    mark_.assign(vertex_.size(), 0);
    hits_.assign(vertex_.size(), 0);
}

void Contractor::add_planes() {
    for (const Corners& c : triangle_) {
        const Eigen::Vector3f a = vertex_[c[0]].at();
        const Eigen::Vector3f normal = (vertex_[c[1]].at() - a).cross(vertex_[c[2]].at() - a);
        const float double_area = normal.norm();
        if (!(double_area > 0.0F)) continue;
        for (const std::uint32_t v : c) vertex_[v].q.add_plane(normal / double_area, 0.5F * double_area);
    }
    // An edge with other than two triangles is a border.
    for (std::uint32_t u = 0; u < vertex_.size(); ++u) {
        gather(u);
        for (const std::uint32_t w : ring_) {
            if (hits_[w] == 2 || w < u) continue;
            vertex_[u].stamp |= kBorder;
            vertex_[w].stamp |= kBorder;
            add_border(u, w);
        }
    }
}

// A plane through the edge, upright on its triangle, holds the border.
void Contractor::add_border(std::uint32_t u, std::uint32_t w) {
    const Eigen::Vector3f edge = vertex_[w].at() - vertex_[u].at();
    for (std::uint32_t i = 0; i < vertex_[u].count; ++i) {
        const Corners& c = triangle_[touch_[vertex_[u].first + i]];
        if (std::find(c.begin(), c.end(), w) == c.end()) continue;
        const Eigen::Vector3f a = vertex_[c[0]].at();
        const Eigen::Vector3f up = (vertex_[c[1]].at() - a).cross(vertex_[c[2]].at() - a).cross(edge);
        const float length = up.norm();
        if (!(length > 0.0F)) continue;
        const float weight = static_cast<float>(settings_.boundary_weight) * edge.squaredNorm();
        vertex_[u].q.add_plane(up / length, weight);
        vertex_[w].q.add_plane(up / length, weight);
    }
}

// Fills ring_ with the neighbours of u and hits_ with the number of triangles shared with each.
void Contractor::gather(std::uint32_t u) {
    ++epoch_;
    ring_.clear();
    const Vertex& vertex = vertex_[u];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        for (const std::uint32_t w : triangle_[touch_[vertex.first + i]]) {
            if (w == u) continue;
            if (mark_[w] != epoch_) {
                mark_[w] = epoch_;
                hits_[w] = 0;
                ring_.push_back(w);
            }
            ++hits_[w];
        }
    }
}

void Contractor::queue_all(const Progress& progress) {
    for (std::uint32_t u = 0; u < vertex_.size(); ++u) {
        if (u % 65536 == 0)
            report(progress, 0.1 * u / static_cast<double>(vertex_.size()), "simplify: pairs");
        gather(u);
        for (const std::uint32_t w : ring_) {
            if (w > u) push(u, w);
        }
    }
}

void Contractor::push(std::uint32_t u, std::uint32_t v) {
    const Vertex &a = vertex_[u], &b = vertex_[v];
    queue_.push(best(sum_about_first(a, b), b.at() - a.at()).cost, {u, v, a.stamp + b.stamp});
}

Quadric Contractor::sum_about_first(const Vertex& u, const Vertex& v) {
    Quadric sum = v.q.about(u.at() - v.at());
    sum += u.q;
    return sum;
}

Contractor::Place Contractor::best(const Quadric& sum, const Eigen::Vector3f& across) const {
    const Eigen::Vector3f middle = 0.5F * across;
    Place place{minimum(sum, middle, kPull), 0.0F};
    if (!((place.shift - middle).squaredNorm() <= kFar * kFar * across.squaredNorm())) {
        // The best point on the edge.
        const float curve = across.dot(sum.times(across));
        const float t = curve > 0.0F ? std::clamp(-across.dot(sum.b()) / curve, 0.0F, 1.0F) : 0.5F;
        place.shift = t * across;
    }
    place.cost = sum(place.shift);
    return place;
}

void Contractor::look(std::uint32_t self, const Eigen::Vector3f& origin, Star& star) const {
    const Vertex& vertex = vertex_[self];
    star.resize(vertex.count);
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        Wing& wing = star[i];
        wing.triangle = touch_[vertex.first + i];
        const Corners& c = triangle_[wing.triangle];
        const bool first = c[0] == self, second = c[1] == self;
        wing.next = first ? c[1] : second ? c[2] : c[0];
        wing.last = first ? c[2] : second ? c[0] : c[1];
        wing.p_next = vertex_[wing.next].at() - origin;
        wing.p_last = vertex_[wing.last].at() - origin;
    }
}

// Moves the place so that the volume on either side of the surface stays as it is (Lindstrom, Turk 1998), by
// the way that costs least in the quadric. The optimum of the quadric alone lies outside of rounded surfaces.
void Contractor::keep_volume(const Quadric& sum, std::uint32_t u, const Eigen::Vector3f& across,
                             Place& place) const {
    Eigen::Vector3f g = Eigen::Vector3f::Zero();  // g . d = h keeps the volume
    float h = 0.0F;
    for (const Wing& wing : star_u_) g += wing.p_next.cross(wing.p_last);
    for (const Wing& wing : star_v_) {
        if (wing.next == u || wing.last == u) continue;
        const Eigen::Vector3f n = (wing.p_next - across).cross(wing.p_last - across);
        g += n;
        h += n.dot(across);
    }
    const float scale = g.norm();
    if (!(scale > 0.0F)) return;
    g /= scale;
    h /= scale;
    Quadric pulled = sum;
    pulled.bx = -g.x();
    pulled.by = -g.y();
    pulled.bz = -g.z();
    const Eigen::Vector3f way = minimum(pulled, Eigen::Vector3f::Zero(), kPull);
    const float gain = g.dot(way);
    if (!(gain > 0.0F)) return;
    const Eigen::Vector3f move = way * ((h - g.dot(place.shift)) / gain);
    if (!(move.squaredNorm() <= kVolumeFar * kVolumeFar * across.squaredNorm())) return;
    place.shift += move;
    place.cost = sum(place.shift);
}

// The link condition: the pair's common neighbours are those across its own triangles, no more.
bool Contractor::topology_allows(std::uint32_t u, std::uint32_t v) {
    const Vertex &a = vertex_[u], &b = vertex_[v];
    std::uint32_t shared = 0, common = 0;
    for (const Wing& wing : star_u_) shared += (wing.next == v || wing.last == v) ? 1 : 0;
    if (shared == 0) return false;
    const bool both_border = (a.stamp & b.stamp & kBorder) != 0;
    if (both_border && shared == 2) return false;  // would pinch the sheet
    if (a.count + b.count <= 2 * shared + 1) return false;
    if (!both_border && a.count == 3 && b.count == 3) return false;  // a tetrahedron would fold flat
    if (((a.stamp | b.stamp) & kBorder) == 0 && a.count <= 24) {
        // Around an inner vertex every neighbour is the next corner of one triangle.
        for (const Wing& wing : star_v_) {
            for (const Wing& other : star_u_) common += wing.next == other.next ? 1 : 0;
        }
        return common == shared;
    }
    gather(u);
    for (const Wing& wing : star_v_) {
        for (const std::uint32_t w : {wing.next, wing.last}) {
            if (w == u || mark_[w] != epoch_) continue;
            mark_[w] = epoch_ - 1;  // count it once
            ++common;
        }
    }
    return common == shared;
}

bool Contractor::turns_over(const Star& star, std::uint32_t other, const Eigen::Vector3f& from,
                            const Eigen::Vector3f& to) {
    for (const Wing& wing : star) {
        if (wing.next == other || wing.last == other) continue;
        const Eigen::Vector3f before = (wing.p_next - from).cross(wing.p_last - from);
        const Eigen::Vector3f after = (wing.p_next - to).cross(wing.p_last - to);
        const float double_area = after.norm(), was = before.norm();
        if (!(before.dot(after) > kTurnCosine * was * double_area)) return true;
        if (roundness(wing.p_next - to, wing.p_last - to, double_area) < kThin &&
            roundness(wing.p_next - from, wing.p_last - from, was) > kThin)
            return true;
        leaf_.push_back({wing.next, wing.last, after / double_area});
    }
    return false;
}

// Two triangles at the new vertex would lie nearly face to face.
bool Contractor::folds() const {
    for (const Leaf& a : leaf_) {
        for (const Leaf& b : leaf_) {
            if (a.last == b.next && a.normal.dot(b.normal) < kFoldCosine) return true;
        }
    }
    return false;
}

bool Contractor::try_pair(std::uint32_t u, std::uint32_t v) {
    const Eigen::Vector3f origin = vertex_[u].at();
    const Eigen::Vector3f across = vertex_[v].at() - origin;
    look(u, origin, star_u_);
    look(v, origin, star_v_);
    if (!topology_allows(u, v)) return false;
    const Quadric sum = sum_about_first(vertex_[u], vertex_[v]);
    Place place = best(sum, across);
    const Eigen::Vector3f plain = place.shift;
    if (((vertex_[u].stamp | vertex_[v].stamp) & kBorder) == 0) keep_volume(sum, u, across, place);
    const auto turns = [&](const Eigen::Vector3f& to) {
        leaf_.clear();
        return turns_over(star_u_, v, Eigen::Vector3f::Zero(), to) || turns_over(star_v_, u, across, to) ||
               folds();
    };
    if (turns(place.shift)) {
        if (place.shift == plain || turns(plain)) return false;
        place = {plain, sum(plain)};
    }
    contract(u, v, sum, place);
    return true;
}

void Contractor::drop_touch(std::uint32_t w, std::uint32_t t) {
    Vertex& vertex = vertex_[w];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        if (touch_[vertex.first + i] != t) continue;
        touch_[vertex.first + i] = touch_[vertex.first + --vertex.count];
        return;
    }
}

void Contractor::compact_touch() {
    HugeVector<std::uint32_t> compact;
    compact.reserve(touch_.capacity());
    for (Vertex& v : vertex_) {
        const auto from = touch_.begin() + v.first;
        if (v.count > 0) compact.insert(compact.end(), from, from + v.count);
        v.first = static_cast<std::uint32_t>(compact.size()) - v.count;
    }
    touch_ = std::move(compact);
}

void Contractor::contract(std::uint32_t u, std::uint32_t v, const Quadric& sum, const Place& place) {
    if (touch_.size() > touch_limit_) compact_touch();
    Vertex &a = vertex_[u], &b = vertex_[v];
    // Triangles of both go; those of v alone become u's. The new list of u lies at the end of touch_.
    const auto first = static_cast<std::uint32_t>(touch_.size());
    for (const Wing& wing : star_u_) {
        if (wing.next == v || wing.last == v) {
            drop_touch(wing.next == v ? wing.last : wing.next, wing.triangle);
            triangle_[wing.triangle][0] = kNone;
        } else {
            touch_.push_back(wing.triangle);
        }
    }
    for (const Wing& wing : star_v_) {
        if (wing.next == u || wing.last == u) continue;
        for (std::uint32_t& w : triangle_[wing.triangle]) w = w == v ? u : w;
        touch_.push_back(wing.triangle);
    }
    a.q = sum.about(place.shift);
    for (std::size_t i = 0; i < 3; ++i) a.p[i] += place.shift[static_cast<Eigen::Index>(i)];
    a.first = first;
    a.count = static_cast<std::uint32_t>(touch_.size()) - first;
    a.stamp = ((a.stamp + 1) & ~kBorder) | ((a.stamp | b.stamp) & kBorder);
    b.stamp += 1U << 20;
    b.count = 0;
    --alive_;

    error_ = std::max(error_, std::sqrt(place.cost / std::max(sum.trace(), 1e-30F)));
    const auto model = [&](std::size_t i) {
        return static_cast<float>(centre_[static_cast<Eigen::Index>(i)] +
                                  extent_ * static_cast<double>(a.p[i]));
    };
    result_.contraction.push_back(
        {u, v, {model(0), model(1), model(2)}, static_cast<float>(extent_ * static_cast<double>(error_))});
    if ((a.stamp & kBorder) == 0) {
        for (const Wing& wing : star_u_) {
            if (wing.next != v && wing.last != v) push(u, wing.next);
        }
        for (const Wing& wing : star_v_) {
            if (wing.next != u && wing.last != u) push(u, wing.next);
        }
        return;
    }
    gather(u);
    for (const std::uint32_t w : ring_) push(u, w);
}

void Contractor::fetch_lists(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u, pair.v}) __builtin_prefetch(touch_.data() + vertex_[v].first);
}

void Contractor::fetch_triangles(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u, pair.v}) {
        const std::uint32_t* list = touch_.data() + vertex_[v].first;
        for (std::uint32_t i = 0; i < std::min(vertex_[v].count, 12U); ++i)
            __builtin_prefetch(triangle_.data() + list[i]);
    }
}

void Contractor::fetch_neighbours(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u, pair.v}) {
        const std::uint32_t* list = touch_.data() + vertex_[v].first;
        for (std::uint32_t i = 0; i < std::min(vertex_[v].count, 12U); ++i) {
            for (const std::uint32_t w : triangle_[list[i]]) __builtin_prefetch(vertex_.data() + w);
        }
    }
}

// Takes pairs from the queue some turns before they are due and calls for the memory that they will need, one
// hop a stage: vertices, lists, triangles, neighbours.
bool Contractor::ahead(QueuedPair& pair, float& due) {
    // Near the end a dozen pairs out of order would matter, and everything is in the cache.
    const std::uint32_t depth = alive_ > 8192 ? 13 : 1;
    while (waiting_end_ - waiting_first_ < depth) {
        Waiting& next = waiting_[waiting_end_ % waiting_.size()];
        if (!queue_.pop(next.pair, next.due)) break;
        __builtin_prefetch(vertex_.data() + next.pair.u);
        __builtin_prefetch(vertex_.data() + next.pair.v);
        ++waiting_end_;
        const auto stage = [&](std::uint32_t back, auto&& fetch) {
            if (waiting_end_ - waiting_first_ < back + 1) return;
            const QueuedPair& p = waiting_[(waiting_end_ - 1 - back) % waiting_.size()].pair;
            if (current(p)) fetch(p);
        };
        stage(4, [&](const QueuedPair& p) { fetch_lists(p); });
        stage(7, [&](const QueuedPair& p) { fetch_triangles(p); });
        stage(10, [&](const QueuedPair& p) { fetch_neighbours(p); });
    }
    if (waiting_first_ == waiting_end_) return false;
    const Waiting& now = waiting_[waiting_first_++ % waiting_.size()];
    pair = now.pair;
    due = now.due;
    return true;
}

Simplified Contractor::run(const Progress& progress) {
    queue_all(progress);
    const std::uint32_t start = alive_;
    QueuedPair pair{};
    float due = 0.0F;
    while (alive_ > settings_.vertices_min && ahead(pair, due)) {
        if (!current(pair)) continue;
        std::uint32_t u = pair.u, v = pair.v;
        if (vertex_[u].count < vertex_[v].count) std::swap(u, v);
        if (try_pair(u, v)) {
            if (alive_ % 65536 == 0)
                report(progress, 0.1 + 0.9 * (1.0 - static_cast<double>(alive_) / start), "simplify");
        } else {
            const float later = std::max(due * kRefusedFactor, 1e-20F);
            if (later < kCostMax) queue_.push(later, pair);
        }
    }
    take_rest();
    return std::move(result_);
}

void Contractor::take_rest() {
    std::vector<std::uint32_t> number(vertex_.size(), kNone);
    std::uint32_t next = 0;
    for (std::uint32_t v = 0; v < vertex_.size(); ++v) {
        if (vertex_[v].count == 0) continue;
        number[v] = next++;
        for (int i = 0; i < 3; ++i) {
            result_.mesh.position_m.push_back(static_cast<float>(
                centre_[i] + extent_ * static_cast<double>(vertex_[v].p[static_cast<std::size_t>(i)])));
        }
    }
    for (const Corners& c : triangle_) {
        if (c[0] == kNone) continue;
        for (const std::uint32_t v : c) result_.mesh.triangle.push_back(number[v]);
    }
}

}  // namespace tact
