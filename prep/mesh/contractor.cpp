#include "prep/mesh/contractor.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/prefetch.hpp"

namespace tact {
namespace {

constexpr float kRefusedFactor = 2.0F;  // a refused pair is queued again at twice its cost
constexpr float kOpposedFactor = 8.0F;  // because it would turn a triangle over, which costs more to find out
constexpr float kCostMax = 1e6F;
// Prefetch pipeline: number of pairs popped and of due pairs, and the lag of each further stage.
constexpr std::uint32_t kPoppedDepth = 10, kDueDepth = 12, kTrianglesBack = 3, kNeighboursBack = 7;

}  // namespace

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

bool Contractor::try_pair(std::uint32_t u, std::uint32_t v) {
    const Eigen::Vector3f origin = vertex_[u].at();
    const Eigen::Vector3f across = vertex_[v].at() - origin;
    look(u, origin, star_u_);
    look(v, origin, star_v_);
    if (!topology_allows(u, v)) return false;
    const Quadric sum = sum_about_first(vertex_[u], vertex_[v]);
    Place place = best_place(sum, across);
    const Eigen::Vector3f plain = place.shift;
    if (((vertex_[u].stamp | vertex_[v].stamp) & kBorder) == 0)
        keep_volume(sum, u, across, place);
    else
        keep_border(sum, u, v, place);
    const bool limited = !(settings_.pair_distance > 0.0) && bent(u, v);  // joined parts may vanish
    if (limited) pull_back(sum, across, place);
    // A part that touches another at a vertex may be absorbed by it.
    const bool joint =
        settings_.pair_distance > 0.0 && ((vertex_[u].stamp | vertex_[v].stamp) & kBorder) != 0;
    const auto unsound = [&](const Place& p) {
        return spoils(u, v, across, p.shift, joint) || opposes(sum, u, v, across, p);
    };
    if (unsound(place)) {
        Place other{plain, sum(plain)};
        if (limited) pull_back(sum, across, other);
        if (place.shift == other.shift || unsound(other)) return false;
        place = other;
    }
    lost_next_ = lost_[v][3] != 0.0F ? lost_[v] : lost_[u];
    if (limited && loses(sum, u, v, across, place)) return false;
    lost_[u] = lost_next_;
    contract(u, v, sum, place);
    if (joint) drop_coincident(u);
    if (joint && alive(u)) clear_borders(u);
    return true;
}

void Contractor::drop_touch(std::uint32_t w, std::uint32_t t) {
    Vertex& vertex = vertex_[w];
    for (std::uint32_t i = 0; i < vertex.count; ++i) {
        if (touch_[vertex.first + i] != t) continue;
        touch_[vertex.first + i] = touch_[vertex.first + --vertex.count];
        break;
    }
    if (vertex.count == 0) {  // only if parts meet at a single vertex
        vertex.first = w;
        --alive_;
    }
}

void Contractor::compact_touch() {
    HugeVector<std::uint32_t> compact;
    compact.reserve(touch_.capacity());
    for (Vertex& v : vertex_) {
        if (v.count == 0) continue;
        const auto from = touch_.begin() + v.first;
        compact.insert(compact.end(), from, from + v.count);
        v.first = static_cast<std::uint32_t>(compact.size()) - v.count;
    }
    touch_ = std::move(compact);
}

void Contractor::record(std::uint32_t kept, std::uint32_t gone, float cost, float weight) {
    vertex_[gone].count = 0;
    vertex_[gone].first = kept;
    original_.join(kept, gone);
    --alive_;
    const float own = std::sqrt(cost / std::max(weight, 1e-30F));
    error_ = std::max(error_, own);
    const auto model = [&](std::size_t i) {
        return static_cast<float>(centre_[static_cast<Eigen::Index>(i)] +
                                  extent_ * static_cast<double>(vertex_[kept].p[i]));
    };
    result_.contraction.push_back({kept,
                                   gone,
                                   {model(0), model(1), model(2)},
                                   static_cast<float>(extent_ * static_cast<double>(error_)),
                                   static_cast<float>(extent_ * static_cast<double>(own))});
}

void Contractor::contract(std::uint32_t u, std::uint32_t v, const Quadric& sum, const Place& place) {
    note_bends(u);
    if (touch_.size() > touch_limit_) compact_touch();
    // Removes the triangles of both; those of v alone go to u. The new list of u lies at the end of touch_.
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
    Vertex &a = vertex_[u], &b = vertex_[v];
    if (!reach_.empty())
        reach_[u] =
            std::max(reach_[u] + place.shift.norm(), reach_[v] + (b.at() - a.at() - place.shift).norm());
    facing_[u] += facing_[v];
    a.q = sum.about(place.shift);
    for (std::size_t i = 0; i < 3; ++i) a.p[i] += place.shift[static_cast<Eigen::Index>(i)];
    a.first = first;
    a.count = static_cast<std::uint32_t>(touch_.size()) - first;
    a.stamp = ((a.stamp + 1) & ~kBorder) | ((a.stamp | b.stamp) & kBorder);
    record(u, v, place.cost, sum.trace());

    // Queued pairs of u keep their old cost, a lower bound of the new cost because quadrics only grow; is_due() updates
    // it on pop. Pairs of v alone are queued under u now.
    ++epoch_;
    mark_[u] = mark_[v] = epoch_;
    for (const Wing& wing : star_u_) mark_[wing.next] = mark_[wing.last] = epoch_;
    for (const Wing& wing : star_v_) {
        for (const std::uint32_t w : {wing.next, wing.last}) {
            if (mark_[w] == epoch_) continue;
            mark_[w] = epoch_;
            push(u, w);
        }
    }
}

void Contractor::fetch_lists(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u & ~kNoEdge, pair.v}) {
        prefetch(touch_.data() + vertex_[v].first);
        prefetch(facing_.data() + v);
        original_.prefetch_joint(v);
    }
}

void Contractor::fetch_triangles(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u & ~kNoEdge, pair.v}) {
        const std::uint32_t* list = touch_.data() + vertex_[v].first;
        for (std::uint32_t i = 0; i < std::min(vertex_[v].count, 12U); ++i)
            prefetch(triangle_.data() + list[i]);
    }
}

void Contractor::fetch_neighbours(const QueuedPair& pair) const {
    for (const std::uint32_t v : {pair.u & ~kNoEdge, pair.v}) {
        const std::uint32_t* list = touch_.data() + vertex_[v].first;
        for (std::uint32_t i = 0; i < std::min(vertex_[v].count, 12U); ++i) {
            for (const std::uint32_t w : triangle_[list[i]]) {
                prefetch(vertex_.data() + w);
                prefetch(mark_.data() + w);
                prefetch(facing_.data() + w);
            }
        }
    }
}

// Pops pairs some iterations before they are tried and prefetches their memory in stages: first the vertices; then most
// pairs turn out not to be due; for the others lists, triangles and neighbours.
bool Contractor::ahead(QueuedPair& pair, float& due) {
    // Near the end the order of two dozen pairs would matter, and all data is in the cache.
    const bool far = alive_ > 8192;
    const std::uint32_t popped_depth = far ? kPoppedDepth : 1, due_depth = far ? kDueDepth : 1;
    while (due_.size() < due_depth) {
        while (popped_.size() < popped_depth) {
            Waiting next{};
            if (!queue_.pop(next.pair, next.due)) break;
            prefetch(vertex_.data() + (next.pair.u & ~kNoEdge));
            prefetch(vertex_.data() + next.pair.v);
            popped_.push(next);
        }
        if (popped_.size() == 0) break;
        Waiting next = popped_.take();
        if (!is_due(next.pair, next.due)) continue;
        fetch_lists(next.pair);
        due_.push(next);
        const auto stage = [&](std::uint32_t back, auto&& fetch) {
            if (due_.size() <= back) return;
            const QueuedPair& p = due_.from_end(back).pair;
            if (alive(p.u & ~kNoEdge) && alive(p.v)) fetch(p);
        };
        stage(kTrianglesBack, [&](const QueuedPair& p) { fetch_triangles(p); });
        stage(kNeighboursBack, [&](const QueuedPair& p) { fetch_neighbours(p); });
    }
    if (due_.size() == 0) return false;
    const Waiting now = due_.take();
    pair = now.pair;
    due = now.due;
    return true;
}

// The vertex that a removed vertex was finally merged into; kNone if its last triangle vanished with it.
std::uint32_t Contractor::heir(std::uint32_t v) const {
    while (!alive(v)) {
        if (vertex_[v].first == v) return kNone;
        v = vertex_[v].first;
    }
    return v;
}

// True if the pair is to be tried at this cost; otherwise queues it again if its cost has increased.
bool Contractor::is_due(QueuedPair& pair, float due) {
    const std::uint32_t flag = pair.u & kNoEdge;
    std::uint32_t u = pair.u & ~kNoEdge, v = pair.v;
    if (!alive(u) || !alive(v)) {
        if (flag == 0) return false;  // contract() has queued its heirs
        u = heir(u);
        v = heir(v);
        if (u == kNone || v == kNone || u == v) return false;
    } else if (vertex_[u].stamp + vertex_[v].stamp == pair.stamp) {
        return true;
    }
    pair = {u | flag, v, vertex_[u].stamp + vertex_[v].stamp};
    const float now = cost(u, v);
    if (BucketQueue::in_bucket(now, due)) return true;
    queue_.push(now, pair);
    return false;
}

Simplified Contractor::run(const Progress& progress) {
    queue_all(progress);
    const std::uint32_t start = alive_;
    QueuedPair pair{};
    float due = 0.0F;
    std::uint64_t turn = 0;
    while (alive_ > settings_.vertices_min && ahead(pair, due)) {
        if (++turn % 4096 == 0)
            report(progress, 0.1 + 0.9 * (1.0 - static_cast<double>(alive_) / start), "simplify");
        if (!is_due(pair, due)) continue;
        Tried tried = Tried::refused;
        tried_at_ = due;
        opposed_ = false;
        if ((pair.u & kNoEdge) != 0) {
            tried = try_apart(pair, due);
        } else {
            const bool wider = vertex_[pair.u].count >= vertex_[pair.v].count;
            if (try_pair(wider ? pair.u : pair.v, wider ? pair.v : pair.u)) tried = Tried::done;
        }
        if (tried != Tried::refused) continue;
        const float later = std::max(due * (opposed_ ? kOpposedFactor : kRefusedFactor), 1e-20F);
        if (later < kCostMax) queue_.push(later, pair);
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
        result_.origin.push_back(v);
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
