// Splits all requested nodes with all their needs at once, if the budget covers them.
#include "ipc/base/prefetch.hpp"
#include "ipc/scene/mesh/refinement.hpp"

namespace tact {
namespace {

// Prefetch distance in iterations: for the data that a node names; for its needs.
constexpr std::uint32_t kNamed = 8, kNeeded = 4;

}  // namespace

bool Refinement::want(std::uint32_t n, std::uint32_t most) noexcept {
    if (state_[n].word != 0) return true;  // split, or already in the batch
    if (batch_.count == most) return false;
    state_[n].word = kWanted;
    batch_.node[batch_.count++] = n;
    prefetch(&forest_.node(n));
    return true;
}

void Refinement::fetch_batch(std::uint32_t i) const noexcept {
    if (i + kNamed < batch_.count) {
        const std::uint32_t n = batch_.node[i + kNamed];
        const ForestNode& node = forest_.node(n);
        prefetch(forest_.first_need_of(n));
        prefetch(&node + 1);  // its first child, and the end of this node's lists
        if (!node.first_is_leaf()) prefetch_to_write(&state_[n + 1]);
        if (!node.second_is_leaf()) {
            prefetch(&forest_.node(node.second_of(n)));
            prefetch_to_write(&state_[node.second_of(n)]);
        }
        if (node.parent != kNoForestNode) prefetch_to_write(&state_[node.parent]);
    }
    if (i + kNeeded < batch_.count)
        for (const std::uint32_t need : forest_.needs_of(batch_.node[i + kNeeded]))
            prefetch_to_write(&state_[need]);
}

// Collects all nodes that must be split for the queue, breadth first, so that each node is visited once and
// the memory of the next ones can be prefetched. False: they are more than `most`, and nothing has changed.
bool Refinement::gather(const Queue& asked, const RefineBox& box, std::uint32_t most) noexcept {
    const bool rest = &asked == &ask_rest_;
    const std::uint32_t rest_before = ask_rest_.count;
    const bool rest_was_full = ask_rest_.full;
    batch_.count = 0;
    bool all = !asked.full;
    for (std::uint32_t i = 0; all && i < asked.count; ++i) all = want(asked.node[i], most);
    const auto look_at_child = [&](std::uint32_t child) {
        if (state_[child].word != 0) return;
        const ForestNode& node = forest_.node(child);
        const float distance = box.distance_m(node.position_m);
        if (!(distance < limit_m(node))) return;
        if (rest || distance < node.reach_m + settings_.filter.radius_m())
            all = all && want(child, most);
        else
            ask_rest_.put(child);
    };
    for (std::uint32_t i = 0; all && i < batch_.count; ++i) {
        fetch_batch(i);
        const std::uint32_t n = batch_.node[i];
        const ForestNode& node = forest_.node(n);
        if (node.parent != kNoForestNode) all = want(node.parent, most);
        for (const std::uint32_t need : forest_.needs_of(n)) all = all && want(need, most);
        if (!node.first_is_leaf()) look_at_child(n + 1);
        if (!node.second_is_leaf()) look_at_child(node.second_of(n));
    }
    if (all) return true;
    for (std::uint32_t i = 0; i < batch_.count; ++i) state_[batch_.node[i]].word = 0;
    batch_.count = 0;
    ask_rest_.count = rest_before;
    ask_rest_.full = rest_was_full;
    return false;
}

bool Refinement::split_at_once(const Queue& asked, const RefineBox& box, std::uint32_t& budget) noexcept {
    if (!gather(asked, box, std::min(budget, settings_.nodes_max - vertices_))) return false;
    const auto batch = std::span(batch_.node).first(batch_.count);
    for (const std::uint32_t n : batch) {
        if (state_[n].place != kNone) unlist(frontier_, n);
        state_[n].word = kSplit;
    }
    for (const std::uint32_t n : batch) {
        const std::uint32_t parent = forest_.node(n).parent;
        if (parent != kNoForestNode) hold(parent);
        for (const std::uint32_t need : forest_.needs_of(n)) hold(need);
        triangles_ += static_cast<std::uint32_t>(forest_.triangles_of(n).size());
    }
    // Only now is it known which nodes stay at the cut.
    for (const std::uint32_t n : batch) {
        const ForestNode& node = forest_.node(n);
        if (state_[n].word == kSplit) list(mergeable_, n);
        if (node.first_is_leaf())
            set_active(node.first, true);
        else if (!is_split(n + 1))
            list(frontier_, n + 1);
        if (node.second_is_leaf())
            set_active(node.middle, true);
        else if (!is_split(node.second_of(n)))
            list(frontier_, node.second_of(n));
    }
    vertices_ += batch_.count;
    budget -= batch_.count;
    return true;
}

}  // namespace tact
