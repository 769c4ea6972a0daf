// Keeps the surface fine around the probe and coarse elsewhere: the cut through the forest, changed a
// little in every step (El-Sana, Varshney 1999; ipc/scene/mesh/vertex_forest.hpp).
//
// Step      takes the box that the probe will pass through, splits the parts that are coarser than the
//           filter requires and merges finer ones, first within the filter's radius. Splits and merges have
//           a budget each; forced splits count. If the budget covers all splits they are made at once,
//           otherwise one after the other, and a cascade stops when the budget is used up. Every step ends
//           with a complete surface; the rest follows in the next step
// Unique    for the same filter and box and a sufficient budget the cut is the same, for any earlier path
//           of the probe: the required nodes, and the nodes that these need
// Cost      proportional to the number of changes, plus a test of the nodes at the cut; triangles are not
//           tested
// Memory    8 bytes per node of the forest, 64 per vertex that may be active. Allocated by the constructor
// Frame     model, metres
// Thread    one thread, never the servo's
// Errors    StartupError if nodes_max cannot hold the coarsest mesh. Full lists leave the surface as fine
//           as possible, and the result reports it
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
    double look_ahead_s = 0.015;         // time over which the probe's path is extrapolated and refined
    std::uint32_t splits_max = 4000;     // per step, including forced ones
    std::uint32_t merges_max = 4000;     // per step
    std::uint32_t nodes_max = 1U << 18;  // limit of active vertices
};

struct RefineStep {
    std::uint32_t splits = 0, merges = 0;
    bool settled = false;      // no pending work
    bool full_detail = false;  // everything within the filter's radius of the box equals the full mesh
    bool no_room = false;      // the limit of active vertices is reached
    std::uint32_t vertices = 0, triangles = 0;  // active
    RefineBox path{};                           // box that the probe will pass through
};

class Refinement {
public:
    Refinement(const VertexForest& forest, const RefinementSettings& settings);

    // A non-finite probe changes nothing.
    RefineStep step(const Vec3& probe_m, const Vec3& velocity_m_s) noexcept;
    void set_filter(const RefineFilter& filter) noexcept;
    [[nodiscard]] const RefineFilter& filter() const noexcept { return settings_.filter; }

    // The following functions visit the whole cut, and may allocate.
    // Calls visit(number of the triangle, {three places}) for every active triangle; a place identifies an
    // active vertex until the cut changes.
    template <class Visit>
    void each_triangle(Visit&& visit) const;
    [[nodiscard]] std::array<float, 3> position_m(std::uint32_t place) const {
        return place < forest_.leaves() ? forest_.leaf_position_m(place)
                                        : forest_.node(place - forest_.leaves()).position_m;
    }
    // The vertex of the full mesh, or kNoForestNode.
    [[nodiscard]] std::uint32_t leaf(std::uint32_t place) const {
        return place < forest_.leaves() ? place : kNoForestNode;
    }
    // The active vertex that represents a vertex of the full mesh.
    [[nodiscard]] std::uint32_t place_of(std::uint32_t leaf) const noexcept;
    // Largest distance between the active and the full surface, in both directions. See the forest.
    [[nodiscard]] float deviation_m() const noexcept;
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    static constexpr std::uint32_t kSplit = 1U << 31;
    static constexpr std::uint32_t kWanted = 1U << 30;  // used within gather() only

    struct State {            // per node
        std::uint32_t word;   // kSplit, and the number of split nodes that are its children or need it
        std::uint32_t place;  // in mergeable_ if split and not needed, in frontier_ if active
    };
    enum class Done : std::uint8_t { yes, out_of_budget, no_room };
    struct Queue {  // of nodes; nodes that do not fit are found again in the next step
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
    HugeVector<std::uint64_t> active_leaf_;  // one bit per vertex of the full mesh: active
    CutList frontier_;                       // active nodes
    CutList mergeable_;                      // split nodes that no split node needs
    std::uint32_t vertices_ = 0, triangles_ = 0;
    Queue ask_full_, ask_rest_, ask_merge_;  // within the radius; elsewhere; to merge
    Queue batch_;                            // nodes that are split at once
    HugeVector<std::uint32_t> stack_;
};

template <class Visit>
void Refinement::each_triangle(Visit&& visit) const {
    std::vector<Level> path;
    const auto place = [&](std::uint32_t leaf) {
        if (is_active(leaf)) return leaf;
        for (std::size_t i = path.size(); i-- > 0;)  // the third corner is likely to be in a nearby branch
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
