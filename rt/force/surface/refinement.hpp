// Keeps the surface fine around the probe and coarse elsewhere: the cut through the forest, changed a little in
// every step (El-Sana, Varshney 1999; ipc/assets/vertex_forest.hpp).
//
// A step    takes the box that the probe is about to pass through, merges what is finer than the filter asks for
//           there and splits what is coarser, nearest first. Splits and merges have a budget each; splits that
//           others force count, and a cascade stops in the middle when the budget is out. Every state between
//           two of them is a whole surface; what is left is done in the next step.
// Same      where the filter and the box are the same and the budget is not out, the cut is the same, wherever
//           the probe came from.
// Memory    none per triangle of the mesh: records of what is active alone, in pools of nodes_max. All is taken
//           by the constructor.
// Frame     model, metres.  Thread  one thread calls step() and set_filter(), never the servo's; near() is for
//           the servo.
// Fails by  StartupError where nodes_max cannot hold the coarsest mesh. Full pools leave the surface as fine as
//           they can, and say so.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/assets/vertex_forest.hpp"
#include "ipc/base/huge_pages.hpp"
#include "ipc/base/pose.hpp"
#include "rt/force/surface/near_triangles.hpp"
#include "rt/force/surface/refine_filter.hpp"

namespace tact {

struct RefineSettings {
    RefineFilter filter;
    double look_ahead_s = 0.015;         // how far ahead of the probe its path is refined
    double near_m = 0.0;                 // around that path: what near() holds
    std::uint32_t near_max = 8192;       // triangles
    std::uint32_t splits_max = 4000;     // a step, forced ones too
    std::uint32_t merges_max = 4000;     // a step
    std::uint32_t nodes_max = 1U << 18;  // vertices active at the same time
};

struct RefineStep {
    std::uint32_t splits = 0, merges = 0;
    bool settled = false;      // nothing was left to do
    bool full_detail = false;  // all within the filter's radius of the box is as in the full mesh
    bool no_room = false;      // the pools were full
    std::uint32_t vertices = 0, triangles = 0;  // active
};

class Refinement {
public:
    Refinement(const VertexForest& forest, const RefineSettings& settings);

    // A probe that is not finite changes nothing.
    RefineStep step(const Vec3& probe_m, const Vec3& velocity_m_s) noexcept;
    void set_filter(const RefineFilter& filter) noexcept;
    [[nodiscard]] const RefineFilter& filter() const noexcept { return settings_.filter; }

    // Servo thread.
    [[nodiscard]] const NearTriangles& near() noexcept TACT_RT { return near_.newest(); }

    // visit(number of the triangle, {three places}) for every active triangle; a place names an active vertex
    // as long as the cut stays. position_m(place), leaf(place): the full mesh's vertex, or kNoForestNode.
    template <class Visit>
    void each_triangle(Visit&& visit) const {
        for (std::uint32_t s = 0; s < triangle_used_; ++s)
            if (triangle_[s].number != kNone) visit(triangle_[s].number, triangle_[s].at);
    }
    [[nodiscard]] const std::array<float, 3>& position_m(std::uint32_t place) const {
        return record_[place].position_m;
    }
    [[nodiscard]] std::uint32_t leaf(std::uint32_t place) const {
        return record_[place].node == kNoForestNode ? key_[place].first : kNoForestNode;
    }
    // The active vertex that stands for a vertex of the full mesh.
    [[nodiscard]] std::uint32_t place_of(std::uint32_t leaf) const noexcept;
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    // A node or leaf at the cut, or above it. Siblings lie in one line of the cache, at 2 i and 2 i + 1.
    struct alignas(32) Record {
        std::array<float, 3> position_m;
        std::uint32_t node;    // kNoForestNode: the leaf `first`
        std::uint32_t parent;  // record
        std::uint32_t child;   // record of the first one, the second comes after it; kNone at the cut
        std::uint32_t head;    // its list of corners; of a free pair: the next free one
        std::uint32_t listed;  // its entry in splittable_ or mergeable_
        [[nodiscard]] bool at_cut() const { return child == kNone; }
    };
    // Of each record, what neighbours look at.
    struct Key {
        std::uint32_t first, end;             // leaves below
        std::uint32_t number, parent_number;  // of merges; 0 for a leaf, kNone above a root
        [[nodiscard]] bool holds(std::uint32_t leaf) const { return leaf >= first && leaf < end; }
    };
    struct Size {  // of each record; a leaf has none
        float reach_m, error_m;
    };
    // Corner k of triangle s is 4 s + k in lists.
    struct alignas(32) Triangle {
        std::array<std::uint32_t, 3> at, next;
        std::uint32_t number;  // kNone: free, and next[0] the next free
        std::uint32_t seen;    // by collect()
    };
    struct alignas(16) Leaves {  // of each triangle
        std::array<std::uint32_t, 3> leaf;
    };
    struct Entry {
        std::array<float, 3> position_m;
        float limit_m, full_limit_m;  // to be split where the box is nearer; where it is in the full radius
        std::uint32_t record;
        std::uint32_t blocker, blocker_number;  // who must merge first, and the merge that must be his
    };
    using List = HugeVector<Entry>;  // reserved for all
    struct Box {
        std::array<float, 3> centre_m, half_m;
        [[nodiscard]] float distance_m(const std::array<float, 3>& p) const noexcept {
            return std::max({std::abs(p[0] - centre_m[0]) - half_m[0],
                             std::abs(p[1] - centre_m[1]) - half_m[1],
                             std::abs(p[2] - centre_m[2]) - half_m[2]});
        }
    };
    enum class Done : std::uint8_t { yes, out_of_budget, no_room };

    void begin();
    void fill(std::uint32_t record, const VertexForest::Branch& branch, std::uint32_t parent) noexcept;
    std::uint32_t take_pair() noexcept;
    void release_pair(std::uint32_t first) noexcept;
    std::uint32_t take_triangle(const ForestTriangle& triangle) noexcept;
    void release_triangle(std::uint32_t triangle) noexcept;
    void put(std::uint32_t corner, std::uint32_t record) noexcept;
    void unlink(std::uint32_t corner, std::uint32_t record) noexcept;
    void list(List& in, std::uint32_t record) noexcept;
    void unlist(List& in, std::uint32_t record) noexcept;
    void set_limits(Entry& entry) const noexcept;

    [[nodiscard]] std::uint32_t holder(std::uint32_t leaf, std::uint32_t around) const noexcept;
    [[nodiscard]] bool has_room(std::uint32_t record) const noexcept;
    void split(std::uint32_t record) noexcept;
    Done split_with_forced(std::uint32_t record, std::uint32_t& budget) noexcept;
    [[nodiscard]] bool blocked(Entry& entry) const noexcept;
    void merge(std::uint32_t record) noexcept;
    std::uint32_t merge_all(const Box& box) noexcept;
    Done split_all(const Box& box, bool full, std::uint32_t& budget) noexcept;
    void collect(const Box& box, bool full_detail) noexcept;

    const VertexForest& forest_;
    RefineSettings settings_;
    HugeVector<Record> record_;  // the first ones are the roots, in order
    HugeVector<Key> key_;
    HugeVector<Size> size_;
    HugeVector<Triangle> triangle_;
    HugeVector<Leaves> leaves_;
    std::uint32_t record_used_ = 0, triangle_used_ = 0;  // from there on never taken yet
    std::uint32_t free_pair_ = kNone, free_triangle_ = kNone;
    std::uint32_t vertices_ = 0, triangles_ = 0;
    List splittable_;  // inner nodes at the cut
    List mergeable_;   // nodes both of whose children are at the cut
    std::uint32_t merge_cursor_ = 0;
    HugeVector<std::uint32_t> stack_;
    std::uint64_t steps_ = 0;
    NearExchange near_;
};

}  // namespace tact
