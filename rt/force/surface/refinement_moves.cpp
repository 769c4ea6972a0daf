// Splits and merges: what changes in the cut, and what must be so before.
#include "rt/force/surface/refinement.hpp"

namespace tact {

std::uint32_t Refinement::place_of(std::uint32_t leaf) const noexcept {
    std::uint32_t place = forest_.tree_of(leaf);
    while (!record_[place].at_cut()) {
        const std::uint32_t child = record_[place].child;
        place = key_[child].holds(leaf) ? child : child + 1;
    }
    return place;
}

// The same for a leaf that is likely to lie below a neighbour.
std::uint32_t Refinement::holder(std::uint32_t leaf, std::uint32_t around) const noexcept {
    for (std::uint32_t c = record_[around].head; c != kNone; c = triangle_[c / 4].next[c % 4]) {
        for (const std::uint32_t w : triangle_[c / 4].at)
            if (key_[w].holds(leaf)) return w;
    }
    return place_of(leaf);
}

bool Refinement::has_room(std::uint32_t record) const noexcept {
    return vertices_ < settings_.nodes_max &&
           triangles_ + forest_.triangles_of(record_[record].node).size() <= triangle_.size();
}

void Refinement::split(std::uint32_t record) noexcept {
    const Key key = key_[record];
    const VertexForest::Branch branch{key.first, key.end, record_[record].node};
    const VertexForest::Branch second = forest_.child(branch, 1);
    const std::uint32_t a = take_pair(), b = a + 1;
    fill(a, forest_.child(branch, 0), record);
    fill(b, second, record);
    const auto half = [&](std::uint32_t leaf) { return leaf < second.first ? a : b; };
    // The list as it was tells who stands for the third corner of what appears.
    std::uint32_t fresh = kNone;  // chained by `seen`
    for (const ForestTriangle& t : forest_.triangles_of(branch.node)) {
        const std::uint32_t s = take_triangle(t);
        Triangle& triangle = triangle_[s];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t leaf = t.leaf[k];
            triangle.at[k] = key.holds(leaf) ? half(leaf) : holder(leaf, record);
        }
        triangle.seen = fresh;
        fresh = s;
    }
    for (std::uint32_t c = record_[record].head; c != kNone;) {
        const std::uint32_t next = triangle_[c / 4].next[c % 4];
        put(c, half(leaves_[c / 4].leaf[c % 4]));
        c = next;
    }
    while (fresh != kNone) {
        const std::uint32_t s = fresh;
        fresh = triangle_[s].seen;
        triangle_[s].seen = 0;
        for (std::uint32_t k = 0; k < 3; ++k) put(4 * s + k, triangle_[s].at[k]);
    }
    unlist(splittable_, record);
    Record& r = record_[record];
    r.head = kNone;
    r.child = a;
    if (r.parent != kNone) unlist(mergeable_, r.parent);
    list(mergeable_, record);
    for (const std::uint32_t child : {a, b})
        if (record_[child].node != kNoForestNode) list(splittable_, child);
    ++vertices_;
}

// Neighbours with a higher number go first, theirs before them; numbers rise, so there is an end.
Refinement::Done Refinement::split_with_forced(std::uint32_t record, std::uint32_t& budget) noexcept {
    std::uint32_t top = 0;
    stack_[top++] = record;
    while (top > 0) {
        const std::uint32_t now = stack_[top - 1];
        if (!record_[now].at_cut()) {  // forced by another one meanwhile
            --top;
            continue;
        }
        const std::uint32_t before = top;
        const std::uint32_t number = key_[now].number;
        for (std::uint32_t c = record_[now].head; c != kNone; c = triangle_[c / 4].next[c % 4]) {
            for (const std::uint32_t w : triangle_[c / 4].at) {
                if (key_[w].number <= number || stack_[top - 1] == w) continue;
                if (top == stack_.size()) return Done::no_room;
                stack_[top++] = w;
            }
        }
        if (top != before) continue;
        if (budget == 0) return Done::out_of_budget;
        if (!has_room(now)) return Done::no_room;
        split(now);
        --budget;
        --top;
    }
    return Done::yes;
}

bool Refinement::blocked(Entry& entry) const noexcept {
    if (entry.blocker != kNone) {  // who was in the way may still be
        if (key_[entry.blocker].number == entry.blocker_number && !record_[entry.blocker].at_cut())
            return true;
        entry.blocker = kNone;
    }
    // Of those in the way the one with the highest number is likely to go last: then it is looked at again.
    const std::uint32_t number = key_[entry.record].number, first = record_[entry.record].child;
    std::uint32_t blocker = kNone, highest = 0;
    for (const std::uint32_t child : {first, first + 1}) {
        for (std::uint32_t c = record_[child].head; c != kNone; c = triangle_[c / 4].next[c % 4]) {
            for (const std::uint32_t w : triangle_[c / 4].at) {
                const std::uint32_t up = key_[w].parent_number;
                if (up >= number || up <= highest) continue;
                highest = up;
                blocker = w;
            }
        }
    }
    if (blocker == kNone) return false;
    entry.blocker = record_[blocker].parent;
    entry.blocker_number = highest;
    return true;
}

void Refinement::merge(std::uint32_t record) noexcept {
    const std::uint32_t a = record_[record].child, b = a + 1;
    // A triangle with corners at both goes; the rest is handed to the parent.
    for (std::uint32_t c = record_[a].head; c != kNone;) {
        Triangle& t = triangle_[c / 4];
        const std::uint32_t next = t.next[c % 4];
        std::uint32_t other = 0;  // corner at b
        while (other < 3 && t.at[other] != b) ++other;
        if (other == 3) {
            put(c, record);
        } else {
            const std::uint32_t third = 3 - c % 4 - other;
            unlink(c / 4 * 4 + third, t.at[third]);
            t.number = kNone;  // released when it is met from the other side
        }
        c = next;
    }
    for (std::uint32_t c = record_[b].head; c != kNone;) {
        const Triangle& t = triangle_[c / 4];
        const std::uint32_t next = t.next[c % 4];
        if (t.number == kNone)
            release_triangle(c / 4);
        else
            put(c, record);
        c = next;
    }
    unlist(splittable_, a);
    unlist(splittable_, b);
    release_pair(a);
    unlist(mergeable_, record);
    Record& r = record_[record];
    r.child = kNone;
    list(splittable_, record);
    if (r.parent != kNone) {
        const std::uint32_t first = record_[r.parent].child;
        if (record_[first].at_cut() && record_[first + 1].at_cut()) list(mergeable_, r.parent);
    }
    --vertices_;
}

}  // namespace tact
