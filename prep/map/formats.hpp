// The readers behind import_map.hpp and their shared functions.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "prep/map/import_map.hpp"

namespace tact::map_format {

ImportedMap read_mrc(std::vector<char> bytes, const std::string& name);
ImportedMap read_situs(const std::vector<char>& bytes, const std::string& name);

// A grid whose axes are not at right angles; the columns are the steps from voxel to voxel, in metres.
struct SkewGrid {
    std::array<std::uint32_t, 3> size{};
    Vec3 origin_m = Vec3::Zero();
    Eigen::Matrix3d step_m = Eigen::Matrix3d::Identity();
    std::vector<float> values;
};
// Trilinear resampling onto axes at right angles, at the finest step of the skew grid. Outside the skew grid the value
// is the mean of its faces.
DensityGrid resample(const SkewGrid& skew, const std::string& name);

}  // namespace tact::map_format
