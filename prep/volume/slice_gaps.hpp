// The distances between the slices of a series: which slices are missing, and which belong to a part with another spacing.
//
// Part      at least kPartGaps successive distances that are equal: some protocols scan the skull base finely and the rest coarsely.
//           Such slices are all there, and are resampled by their positions
// Missing   between two slices that are farther apart than those of the part beside them
// Thread    any
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tact {

inline constexpr std::size_t kPartGaps = 4;

struct SlicePart {
    std::size_t first = 0, gaps = 0;
    double spacing_mm = 0.0;
};
struct MissingSlices {
    std::size_t after = 0;  // index of the slice before them
    std::size_t count = 0;
};
struct SliceGaps {
    std::vector<SlicePart> parts;  // in order; one, or none, if the slices are even or there are few
    std::vector<MissingSlices> missing;
    double typical_mm = 0.0;  // median
};

// at_mm: positions along the normal, rising; at least two.
[[nodiscard]] SliceGaps slice_gaps(std::span<const double> at_mm);

}  // namespace tact
