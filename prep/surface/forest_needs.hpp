// Computes the nodes of a forest that must be split before each node (ipc/scene/mesh/vertex_forest.hpp, "Needs").
//
// Places    input leaf v is v, the node made by merge s is leaves + s. Places of nodes rise in the order of the merges
//           and are above those of all leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

// Ancestor queries by parents and jump pointers (Myers 1983): the number of steps grows with the logarithm of the
// depth, which matters because the tree of a fan is as deep as it is wide.
class Ancestors {
public:
    // parent[p] is kNoForestNode for a root. `parent` must outlive this object.
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

// corner: places of leaves, 3 per triangle. number: for each place, the number of its leaf or node in the forest.
// Writes first_need of the nodes; all their other fields must be set, in the order of the forest.
std::vector<std::uint32_t> forest_needs(std::span<const std::uint32_t> corner, std::uint32_t leaves,
                                        const Ancestors& ancestors, std::span<const std::uint32_t> number,
                                        std::span<ForestNode> node);

}  // namespace tact
