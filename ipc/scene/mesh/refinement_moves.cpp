// Splits and merges: the changes of the cut, and their preconditions.
#include "ipc/base/prefetch.hpp"
#include "ipc/scene/mesh/refinement.hpp"

namespace tact {
namespace {

// Prefetch distances in iterations: a node and its state; the data that it names; its needs.
constexpr std::uint32_t kFirst = 12, kSecond = 8, kThird = 4;

}  // namespace

// Each prefetch uses data loaded by the previous one.
void Refinement::fetch_ahead(const Queue& queue, std::uint32_t i) const noexcept {
    if (i + kFirst < queue.count) {
        const std::uint32_t n = queue.node[i + kFirst];
        prefetch(&forest_.node(n));
        prefetch_to_write(&state_[n]);
    }
    if (i + kSecond < queue.count) {
        const std::uint32_t n = queue.node[i + kSecond];
        const ForestNode& node = forest_.node(n);
        prefetch(forest_.first_need_of(n));
        if (!node.first_is_leaf()) {
            prefetch(&node + 1);
            prefetch_to_write(&state_[n + 1]);
        }
        if (!node.second_is_leaf()) {
            prefetch(&forest_.node(node.second_of(n)));
            prefetch_to_write(&state_[node.second_of(n)]);
        }
        if (node.parent != kNoForestNode) {
            prefetch(&forest_.node(node.parent));
            prefetch_to_write(&state_[node.parent]);
        }
    }
    if (i + kThird < queue.count)
        for (const std::uint32_t need : forest_.needs_of(queue.node[i + kThird])) {
            prefetch_to_write(&state_[need]);
            prefetch(&forest_.node(need));
        }
}

// Puts the node at a place of the frontier into one of the split queues.
void Refinement::ask(std::uint32_t place, const RefineBox& box) noexcept {
    const bool full = frontier_.reached(place, box, settings_.filter.radius_m());
    (full ? ask_full_ : ask_rest_).put(frontier_.node(place));
}

void Refinement::hold(std::uint32_t n) noexcept {
    if (state_[n].word == kSplit && state_[n].place != kNone) unlist(mergeable_, n);
    ++state_[n].word;
}

void Refinement::let_go(std::uint32_t n, const RefineBox& box) noexcept {
    if (--state_[n].word != kSplit) return;
    const ForestNode& node = forest_.node(n);
    const bool within = box.distance_m(node.position_m) < limit_m(node);
    if (within || !ask_merge_.put(n)) list(mergeable_, n);
}

void Refinement::split(std::uint32_t n, const RefineBox& box) noexcept {
    const ForestNode& node = forest_.node(n);
    unlist(frontier_, n);
    state_[n].word = kSplit;
    list(mergeable_, n);
    if (node.parent != kNoForestNode) hold(node.parent);
    for (const std::uint32_t need : forest_.needs_of(n)) hold(need);
    const auto add = [&](std::uint32_t child) {
        list(frontier_, child);
        if (frontier_.within(state_[child].place, box)) ask(state_[child].place, box);
    };
    if (node.first_is_leaf())
        set_active(node.first, true);
    else
        add(n + 1);
    if (node.second_is_leaf())
        set_active(node.middle, true);
    else
        add(node.second_of(n));
    ++vertices_;
    triangles_ += static_cast<std::uint32_t>(forest_.triangles_of(n).size());
}

// A node that must be split before n, or kNone.
std::uint32_t Refinement::unmet_need(std::uint32_t n) const noexcept {
    const std::uint32_t parent = forest_.node(n).parent;
    if (parent != kNoForestNode && !is_split(parent)) return parent;
    for (const std::uint32_t need : forest_.needs_of(n))
        if (!is_split(need)) return need;
    return kNone;
}

// Needs are split first, and their own needs before them; numbers increase, so the recursion ends.
Refinement::Done Refinement::split_with_forced(std::uint32_t n, const RefineBox& box,
                                               std::uint32_t& budget) noexcept {
    std::uint32_t top = 0;
    stack_[top++] = n;
    while (top > 0) {
        const std::uint32_t now = stack_[top - 1];
        const std::uint32_t need = unmet_need(now);
        if (need != kNone) {
            if (top == stack_.size()) return Done::no_room;
            stack_[top++] = need;
            continue;
        }
        if (budget == 0) return Done::out_of_budget;
        if (vertices_ >= settings_.nodes_max) return Done::no_room;
        split(now, box);
        --budget;
        --top;
    }
    return Done::yes;
}

// Children that must be split too are appended to the queue during the loop.
Refinement::Done Refinement::split_queue(Queue& queue, const RefineBox& box, std::uint32_t& budget) noexcept {
    if (split_at_once(queue, box, budget)) return Done::yes;
    Done all = Done::yes;
    for (std::uint32_t i = 0; i < queue.count; ++i) {
        fetch_ahead(queue, i);
        const std::uint32_t n = queue.node[i];
        if (is_split(n)) continue;  // already forced by another node
        const Done done = split_with_forced(n, box, budget);
        if (done == Done::out_of_budget) return done;
        if (done == Done::no_room) all = done;
    }
    return queue.full ? Done::out_of_budget : all;
}

// merge_all() updates the lists afterwards.
void Refinement::merge(std::uint32_t n, const RefineBox& box) noexcept {
    const ForestNode& node = forest_.node(n);
    const auto take_away = [&](std::uint32_t child) {
        if (state_[child].place != kNone) unlist(frontier_, child);
    };
    if (node.first_is_leaf())
        set_active(node.first, false);
    else
        take_away(n + 1);
    if (node.second_is_leaf())
        set_active(node.middle, false);
    else
        take_away(node.second_of(n));
    if (state_[n].place != kNone) unlist(mergeable_, n);
    state_[n].word = 0;
    if (node.parent != kNoForestNode) let_go(node.parent, box);
    for (const std::uint32_t need : forest_.needs_of(n)) let_go(need, box);
    --vertices_;
    triangles_ -= static_cast<std::uint32_t>(forest_.triangles_of(n).size());
}

// Merges nodes that are not needed and not required by the filter; then the nodes that only those needed.
std::uint32_t Refinement::merge_all(const RefineBox& box) noexcept {
    ask_merge_.count = 0;
    ask_merge_.full = false;
    mergeable_.each(box, false, [&](std::uint32_t i) { ask_merge_.put(mergeable_.node(i)); });
    for (std::uint32_t i = 0; i < ask_merge_.count; ++i) {
        fetch_ahead(ask_merge_, i);
        merge(ask_merge_.node[i], box);
    }
    // Most of them were merged together with their parents.
    for (std::uint32_t i = 0; i < ask_merge_.count; ++i) {
        const std::uint32_t n = ask_merge_.node[i], parent = forest_.node(n).parent;
        if (parent == kNoForestNode || is_split(parent)) list(frontier_, n);
    }
    return ask_merge_.count;
}

}  // namespace tact
