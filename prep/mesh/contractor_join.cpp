// Pairs without an edge. Two approaching surfaces are first joined at points; where their triangles meet face to face,
// these are removed and leave a passage. A part that has shrunk to a tetrahedron or less is absorbed by the partner.
#include <algorithm>

#include "prep/mesh/contractor.hpp"

namespace tact {
namespace {

constexpr std::size_t kSmallPart =
    4;  // vertices; every closed part has at least 4, and edge contraction cannot reduce such a part further

}  // namespace

// True if v belongs to a part of at most kSmallPart vertices; part_ then holds them, v first.
bool Contractor::small_part(std::uint32_t v, std::uint32_t apart_from) {
    part_.assign(1, v);
    for (std::size_t i = 0; i < part_.size(); ++i) {
        const Vertex& vertex = vertex_[part_[i]];
        for (std::uint32_t k = 0; k < vertex.count; ++k) {
            for (const std::uint32_t w : triangle_[touch_[vertex.first + k]]) {
                if (w == apart_from) return false;
                if (std::find(part_.begin(), part_.end(), w) != part_.end()) continue;
                if (part_.size() == kSmallPart) return false;
                part_.push_back(w);
            }
        }
    }
    return true;
}

Contractor::Tried Contractor::absorb(std::uint32_t into, QueuedPair& pair, float due) {
    const std::uint32_t gone = part_.front();
    Quadric sum;
    for (const std::uint32_t w : part_) sum += vertex_[w].q.about(vertex_[into].at() - vertex_[w].at());
    const float cost = vertex_[into].q.c + sum.c;
    if (!BucketQueue::in_bucket(cost, due)) {
        queue_.push(cost, pair);
        return Tried::dropped;
    }
    for (const std::uint32_t w : part_) {
        for (std::uint32_t k = 0; k < vertex_[w].count; ++k)
            triangle_[touch_[vertex_[w].first + k]][0] = kNone;
    }
    for (const std::uint32_t w : part_) facing_[into] += facing_[w];
    for (std::size_t i = 1; i < part_.size(); ++i) record(gone, part_[i], cost, sum.trace());
    record(into, gone, cost, sum.trace());
    sum += vertex_[into].q;
    vertex_[into].q = sum;
    vertex_[into].stamp = ((vertex_[into].stamp + 1) & ~kBorder) | (vertex_[into].stamp & kBorder);
    return Tried::done;
}

Contractor::Tried Contractor::try_apart(QueuedPair& pair, float due) {
    std::uint32_t u = pair.u & ~kNoEdge, v = pair.v;
    if (vertex_[u].count < vertex_[v].count) std::swap(u, v);
    if (small_part(v, u)) return absorb(u, pair, due);
    if (small_part(u, v)) return absorb(v, pair, due);
    const Eigen::Vector3f origin = vertex_[u].at();
    const Eigen::Vector3f across = vertex_[v].at() - origin;
    look(u, origin, star_u_);
    look(v, origin, star_v_);
    // A common neighbour means that the pair spans a notch of one surface, except at a border or a joint.
    gather(u);
    for (const Wing& wing : star_v_) {
        for (const std::uint32_t w : {wing.next, wing.last}) {
            if (w == u || (mark_[w] == epoch_ && (vertex_[w].stamp & kBorder) == 0)) return Tried::dropped;
        }
    }
    const Quadric sum = sum_about_first(vertex_[u], vertex_[v]);
    const Place place = best_place(sum, across);
    if (spoils(u, v, across, place.shift, true)) return Tried::refused;
    contract(u, v, sum, place);
    vertex_[u].stamp |= kBorder;
    drop_coincident(u);
    if (alive(u)) clear_borders(u);
    return Tried::done;
}

// Among triangles with the same corners at u, removes both of two that face opposite ways, and one of two that face the
// same way. Vertices that lose their last triangle merge into u.
void Contractor::drop_coincident(std::uint32_t u) {
    look(u, vertex_[u].at(), star_u_);
    const auto remove = [&](Wing& wing) {
        triangle_[wing.triangle][0] = kNone;
        for (const std::uint32_t w : {u, wing.next, wing.last}) {
            drop_touch(w, wing.triangle);
            if (w == u || alive(w)) continue;
            ++alive_;
            record(u, w, 0.0F, 1.0F);
        }
        wing.next = wing.last = kNone;
    };
    for (Wing& a : star_u_) {
        for (Wing& b : star_u_) {
            if (&a == &b || a.next == kNone) continue;
            const bool away = a.next == b.last && a.last == b.next;
            if (!away && !(a.next == b.next && a.last == b.last)) continue;
            remove(a);
            if (away) remove(b);
        }
    }
}

// Clears the border flag of vertices that became inner vertices when surfaces joined.
void Contractor::clear_borders(std::uint32_t u) {
    gather(u);
    part_ = ring_;
    part_.push_back(u);
    for (const std::uint32_t v : part_) {
        if ((vertex_[v].stamp & kBorder) == 0 || !alive(v)) continue;
        look(v, vertex_[v].at(), star_u_);
        std::size_t steps = 0;  // around v, from triangle to triangle
        std::uint32_t at = star_u_[0].next;
        bool inside = true;
        do {
            std::uint32_t to = kNone, found = 0;
            for (const Wing& wing : star_u_) {
                if (wing.next != at) continue;
                to = wing.last;
                ++found;
            }
            inside = found == 1;
            at = to;
        } while (inside && ++steps <= star_u_.size() && at != star_u_[0].next);
        if (inside && steps == star_u_.size()) vertex_[v].stamp &= ~kBorder;
    }
}

}  // namespace tact
