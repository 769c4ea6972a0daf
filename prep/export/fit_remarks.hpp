// What is written about saved bodies: the remarks of their files, their matrix files, and the rows of bodies.csv.
#pragma once

#include <string>
#include <vector>

#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "prep/export/poses_file.hpp"
#include "prep/export/write_structure_file.hpp"

namespace tact {

struct SavedFit {
    FitOfBodies numbers;
    double resolution_a = 0.0;
    double contour = 0.0;
};

SavedFit fit_of(const SceneFile& scene, const std::vector<Structure>& structures,
                const std::vector<PlacedBody>& bodies, double contour);

// Of body `index` of `count`; body and move null: of all together.
Remarks remarks_of(const SceneMeta& meta, const SavedFit& fit, std::size_t index, std::size_t count,
                   const PlacedBody* body, const AtomMove* move);

std::string matrix_text(const PlacedBody& body, const std::string& name, const AtomMove& move);

inline constexpr char kCsvHead[] =
    "id,structure,name,file,m11,m12,m13,m14_a,m21,m22,m23,m24_a,m31,m32,m33,m34_a,axis_x,axis_y,axis_z,"
    "angle_deg,com_x_a,com_y_a,com_z_a,resolution_a,cc_zero,cc_mean,overlap,mean_density,mean_density_sigma,"
    "fraction_inside,region_voxels,atoms,clashes\n";

std::string csv_row(const PlacedBody& body, const std::string& name, const std::string& file,
                    const AtomMove& move, const SavedFit& fit, std::size_t index);

}  // namespace tact
