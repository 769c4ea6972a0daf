// Keeps the surface fine around the probe and coarse elsewhere: the cut through the forest, changed a little in
// every step (El-Sana, Varshney 1999; ipc/scene/mesh/vertex_forest.hpp).
//
// A step    takes the box that the probe is about to pass through, splits what is coarser than the filter asks
//           for there and merges what is finer, what is within the filter's radius first. Splits and merges
//           have a budget each; splits that others force count. Where the budget holds all of them they are
//           made at once, else one after the other, and a cascade stops in the middle when the budget is out.
//           Every step ends with a whole surface; what is left is done in the next.
// Same      where the filter and the box are the same and the budget is not out, the cut is the same, wherever
//           the probe came from: what is asked for, and what that needs.
// Cost      follows the number of changes, and a look at the nodes at the cut; no triangle is looked at.
// Memory    8 bytes for each node of the forest, 64 for each vertex that may be active. All is taken by the
//           constructor.
// Frame     model, metres.  Thread  one thread, never the servo's.
// Fails by  StartupError where nodes_max cannot hold the coarsest mesh. Full lists leave the surface as fine as
//           they can, and say so.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/huge_pages.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/scene/mesh/cut_list.hpp"
#include "ipc/scene/mesh/refine_filter.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

struct RefinementSettings {
    RefineFilter filter;
    double look_ahead_s = 0.015;         // how far ahead of the probe its path is refined
    std::uint32_t splits_max = 4000;     // a step, forced ones too
    std::uint32_t merges_max = 4000;     // a step
    std::uint32_t nodes_max = 1U << 18;  // vertices active at the same time
};

struct RefineStep {
    std::uint32_t splits = 0, merges = 0;
    bool settled = false;      // nothing was left to do
    bool full_detail = false;  // all within the filter's radius of the box is as in the full mesh
    bool no_room = false;      // as many vertices as may be are active
    std::uint32_t vertices = 0, triangles = 0;  // active
    RefineBox path{};                           // what the probe is about to pass through
};

class Refinement {
public:
    Refinement(const VertexForest& forest, const RefinementSettings& settings);

    // A probe that is not finite changes nothing.
    RefineStep step(const Vec3& probe_m, const Vec3& velocity_m_s) noexcept;
    void set_filter(const RefineFilter& filter) noexcept;
    [[nodiscard]] const RefineFilter& filter() const noexcept { return settings_.filter; }

    // The rest looks at the whole cut, and may allocate.
    // visit(number of the triangle, {three places}) for every active triangle; a place names an active vertex
    // as long as the cut stays.
    template <class Visit>
    void each_triangle(Visit&& visit) const;
    [[nodiscard]] std::array<float, 3> position_m(std::uint32_t place) const {
        return place < forest_.leaves() ? forest_.leaf_position_m(place)
                                        : forest_.node(place - forest_.leaves()).position_m;
    }
    // The full mesh's vertex, or kNoForestNode.
    [[nodiscard]] std::uint32_t leaf(std::uint32_t place) const {
        return place < forest_.leaves() ? place : kNoForestNode;
    }
    // The active vertex that stands for a vertex of the full mesh.
    [[nodiscard]] std::uint32_t place_of(std::uint32_t leaf) const noexcept;
    // From the full surface, and of the full surface from the active one, at the most. See the forest.
    [[nodiscard]] float deviation_m() const noexcept;
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    static constexpr std::uint32_t kSplit = 1U << 31;
    static constexpr std::uint32_t kWanted = 1U << 30;  // within gather() alone

    struct State {           // of each node
        std::uint32_t word;  // kSplit, and how many split nodes are its children or need it
        std::uint32_t
            place;  // in mergeable_ where it is split and nobody needs it, in frontier_ where it is active
    };
    enum class Done : std::uint8_t { yes, out_of_budget, no_room };
    struct Queue {  // of nodes; what does not fit is found again in the next step
        HugeVector<std::uint32_t> node;
        std::uint32_t count = 0;
        bool full = false;
        bool put(std::uint32_t n) noexcept {
            full = full || count == node.size();
            if (!full) node[count++] = n;
            return !full;
        }
    };
    struct Level {
        VertexForest::Branch branch;
        std::uint32_t next;  // child
    };

    void begin();
    [[nodiscard]] bool is_split(std::uint32_t n) const noexcept { return (state_[n].word & kSplit) != 0; }
    [[nodiscard]] bool is_active(std::uint32_t leaf) const noexcept {
        return (active_leaf_[leaf / 64] >> leaf % 64 & 1U) != 0;
    }
    void set_active(std::uint32_t leaf, bool active) noexcept {
        const std::uint64_t bit = std::uint64_t{1} << leaf % 64;
        active_leaf_[leaf / 64] = active ? active_leaf_[leaf / 64] | bit : active_leaf_[leaf / 64] & ~bit;
    }
    void list(CutList& in, std::uint32_t n) noexcept;
    void unlist(CutList& in, std::uint32_t n) noexcept;
    void hold(std::uint32_t n) noexcept;
    void let_go(std::uint32_t n, const RefineBox& box) noexcept;
    [[nodiscard]] float limit_m(const ForestNode& node) const noexcept;
    [[nodiscard]] std::uint32_t unmet_need(std::uint32_t n) const noexcept;
    void fetch_ahead(const Queue& queue, std::uint32_t i) const noexcept;
    void ask(std::uint32_t place, const RefineBox& box) noexcept;

    void split(std::uint32_t n, const RefineBox& box) noexcept;
    Done split_with_forced(std::uint32_t n, const RefineBox& box, std::uint32_t& budget) noexcept;
    bool want(std::uint32_t n, std::uint32_t most) noexcept;
    void fetch_batch(std::uint32_t i) const noexcept;
    bool gather(const Queue& asked, const RefineBox& box, std::uint32_t most) noexcept;
    bool split_at_once(const Queue& asked, const RefineBox& box, std::uint32_t& budget) noexcept;
    Done split_queue(Queue& queue, const RefineBox& box, std::uint32_t& budget) noexcept;
    void merge(std::uint32_t n, const RefineBox& box) noexcept;
    std::uint32_t merge_all(const RefineBox& box) noexcept;

    [[nodiscard]] std::uint32_t descend(VertexForest::Branch b, std::uint32_t leaf) const noexcept;

    const VertexForest& forest_;
    RefinementSettings settings_;
    HugeVector<State> state_;
    HugeVector<std::uint64_t> active_leaf_;  // a bit each: the full mesh's vertex is there
    CutList frontier_;                       // active nodes
    CutList mergeable_;                      // split nodes that nobody needs
    std::uint32_t vertices_ = 0, triangles_ = 0;
    Queue ask_full_, ask_rest_, ask_merge_;  // within the radius; elsewhere
    Queue batch_;                            // what is split at once
    HugeVector<std::uint32_t> stack_;
};

template <class Visit>
void Refinement::each_triangle(Visit&& visit) const {
    std::vector<Level> path;
    const auto place = [&](std::uint32_t leaf) {
        if (is_active(leaf)) return leaf;
        for (std::size_t i = path.size(); i-- > 0;)  // the third corner is likely to be a near relation
            if (leaf >= path[i].branch.first && leaf < path[i].branch.end)
                return descend(path[i].branch, leaf);
        return place_of(leaf);
    };
    const auto show = [&](const ForestTriangle& t) {
        visit(t.number, std::array{place(t.leaf[0]), place(t.leaf[1]), place(t.leaf[2])});
    };
    const auto go_into = [&](const VertexForest::Branch& b) {
        if (b.is_leaf() || !is_split(b.node)) return;
        path.push_back({b, 0});
        for (const ForestTriangle& t : forest_.triangles_of(b.node)) show(t);
    };
    for (std::uint32_t r = 0; r < forest_.roots(); ++r) {
        go_into(forest_.root(r));
        while (!path.empty()) {
            Level& level = path.back();
            if (level.next == 2)
                path.pop_back();
            else
                go_into(forest_.child(level.branch, level.next++));
        }
    }
    for (const ForestTriangle& t : forest_.triangles_always()) show(t);
}

}  // namespace tact
