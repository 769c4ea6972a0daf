// How well several placed structures together explain a map: the correlation about zero of the sum of their simulated
// densities, or Laplacians, with the map, over the whole box. A place that two structures share is explained twice and lowers it.
//
// Method   each placed structure is a field on the grid of the search; sums of products of fields with the map and with
//          each other give the correlation of any combination without summing fields
// Thread   any; allocates
#pragma once

#include <span>
#include <vector>

#include "ipc/scene/density/simulated_map.hpp"
#include "prep/search/translation_search.hpp"

namespace tact {

// The density, or Laplacian, of one placed structure in a box of the map's voxels.
struct PlacedField {
    VoxelBox box;
    std::vector<float> value;
    double with_map = 0.0, with_itself = 0.0;  // sums of products
};

class JointFit {
public:
    explicit JointFit(SearchMap map);
    [[nodiscard]] PlacedField field(const Structure& structure, const Pose& T_model_body) const;
    [[nodiscard]] static double product(const PlacedField& a, const PlacedField& b);
    [[nodiscard]] double correlation(std::span<const PlacedField> fields) const;

    // One of the choices of each structure, so that the correlation is highest: a beam search over the structures in the
    // given order. Returns an index per structure; choices must not be empty.
    [[nodiscard]] std::vector<std::size_t> best(const std::vector<std::vector<PlacedField>>& choices) const;

private:
    SearchMap map_;
    double size_2_ = 0.0;  // sum of the squares of the map
};

}  // namespace tact
