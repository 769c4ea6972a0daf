// Nodes of a cut with the data that decides about their splits and merges; four at a time are compared with
// a box.
//
// Order     any; the last node replaces a removed one. remove() returns the moved node
// Memory    allocated by the constructor
// Thread    that of the refinement
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "ipc/base/huge_pages.hpp"

namespace tact {

// Box around the probe's path; Chebyshev distances, below zero inside.
struct RefineBox {
    std::array<float, 3> centre_m, half_m;
    [[nodiscard]] float distance_m(const std::array<float, 3>& p) const noexcept {
        float most = 0.0F;
        for (std::size_t i = 0; i < 3; ++i) {
            const float d = (p[i] > centre_m[i] ? p[i] - centre_m[i] : centre_m[i] - p[i]) - half_m[i];
            most = i == 0 || d > most ? d : most;
        }
        return most;
    }
    friend bool operator==(const RefineBox&, const RefineBox&) = default;
};

class CutList {
public:
    explicit CutList(std::size_t capacity) : entry_((capacity + 7) / 4 * 4) {}
    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    [[nodiscard]] std::uint32_t node(std::uint32_t place) const noexcept { return entry_[place].node; }
    void set_limit(std::uint32_t place, float limit_m) noexcept { entry_[place].limit_m = limit_m; }
    [[nodiscard]] bool within(std::uint32_t place, const RefineBox& box) const noexcept {
        return box.distance_m(entry_[place].position_m) < entry_[place].limit_m;
    }
    // True if the box plus a margin touches the triangles at the node.
    [[nodiscard]] bool reached(std::uint32_t place, const RefineBox& box, float margin_m) const noexcept {
        return box.distance_m(entry_[place].position_m) < entry_[place].reach_m + margin_m;
    }
    // Returns the new node's place.
    std::uint32_t add(std::uint32_t node, const std::array<float, 3>& position_m, float limit_m,
                      float reach_m) noexcept {
        entry_[size_] = {position_m, limit_m, reach_m, node, {}};
        return size_++;
    }
    // Returns the node that moved to this place, or `none`.
    std::uint32_t remove(std::uint32_t place, std::uint32_t none) noexcept {
        --size_;
        if (place == size_) return none;
        entry_[place] = entry_[size_];
        return entry_[place].node;
    }
    // Calls visit(place) for the nodes that are nearer to the box than their limit, or for the others;
    // visit must not add or remove nodes.
    template <class Visit>
    void each(const RefineBox& box, bool nearer, Visit&& visit) const {
        using Four [[gnu::vector_size(16)]] = float;
        using FourMask [[gnu::vector_size(16)]] = std::int32_t;
        using Halves [[gnu::vector_size(16)]] = long long;
        const auto over = [&](const Four& p, std::size_t axis) {
            const Four d = p - box.centre_m[axis];
            return (d > 0.0F ? d : -d) - box.half_m[axis];
        };
        for (std::uint32_t i = 0; i < size_; i += 4) {
            std::array<Four, 4> row;  // x, y, z, limit of each entry; below transposed
            for (std::uint32_t k = 0; k < 4; ++k) std::memcpy(&row[k], &entry_[i + k], sizeof row[k]);
            const Four xy01 = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5),
                       xy23 = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5),
                       zl01 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7),
                       zl23 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
            const Four x = over(__builtin_shufflevector(xy01, xy23, 0, 1, 4, 5), 0),
                       y = over(__builtin_shufflevector(xy01, xy23, 2, 3, 6, 7), 1),
                       z = over(__builtin_shufflevector(zl01, zl23, 0, 1, 4, 5), 2),
                       limit = __builtin_shufflevector(zl01, zl23, 2, 3, 6, 7);
            const Four xy = x > y ? x : y;
            const FourMask in = (xy > z ? xy : z) < limit;
            const auto wanted = reinterpret_cast<Halves>(nearer ? in : ~in);
            if ((wanted[0] | wanted[1]) == 0) continue;
            for (std::uint32_t k = 0; k < 4 && i + k < size_; ++k)
                if ((in[k] != 0) == nearer) visit(i + k);
        }
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return sizeof(Entry) * entry_.capacity(); }

private:
    struct alignas(32) Entry {
        std::array<float, 3> position_m;
        float limit_m;  // split if the box is nearer, otherwise merge
        float reach_m;  // of the node
        std::uint32_t node;
        std::array<std::uint32_t, 2> unused;
    };
    HugeVector<Entry> entry_;
    std::uint32_t size_ = 0;
};

}  // namespace tact
