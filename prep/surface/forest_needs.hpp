// Which nodes of a forest have to be split before each one is (ipc/scene/mesh/vertex_forest.hpp, "Needs").
//
// Places    leaf v of the mesh as it came is v, the node that merge s makes is leaves + s: places of nodes rise in the
//           order of the merges, and lie above all leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

// Of each place its parent, and an ancestor farther up (Myers 1983): any ancestor is found in a number of steps that
// grows with the logarithm of the depth, where a fan's tree is as deep as it is wide.
class Ancestors {
public:
    // kNoForestNode: a root. Outlives this.
    explicit Ancestors(std::span<const std::uint32_t> parent);
    [[nodiscard]] std::uint32_t parent(std::uint32_t place) const { return parent_[place]; }
    // The highest ancestor below `limit`.
    [[nodiscard]] std::uint32_t highest(std::uint32_t p, std::uint32_t limit) const {
        while (parent_[p] < limit) p = jump_[p] != p && jump_[p] < limit ? jump_[p] : parent_[p];
        return p;
    }

private:
    std::span<const std::uint32_t> parent_;
    std::vector<std::uint32_t> jump_;
};

// corner: places of leaves, 3 a triangle. number: of each place, its leaf's or node's in the forest. Writes first_need
// of the nodes, which are in the forest's order and whole but for that.
std::vector<std::uint32_t> forest_needs(std::span<const std::uint32_t> corner, std::uint32_t leaves,
                                        const Ancestors& ancestors, std::span<const std::uint32_t> number,
                                        std::span<ForestNode> node);

}  // namespace tact
