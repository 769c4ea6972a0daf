// Everything of a baked scene that is drawn or measured, read at once.
//
// Thread   made by load_scene() on the loader thread; immutable afterwards.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gui/render/bonds.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/density/contour_scale.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"

namespace tact {

// A surface to touch with its forest, as mapped.
struct SurfaceDetail {
    SceneFile file;
    SurfaceMesh surface;
    VertexForest forest;
};

// Bone to drill as it was baked, and which structure its voxels belong to, as mapped.
struct SceneBoneContent {
    SceneFile file;
    BoneVolumeView volume;
    BoneLabelsView labels;                   // none: no structures
    std::vector<DistanceField> distances;    // to the critical ones
    std::vector<std::uint8_t> free_cells{};  // as baked (BoneField); none: measured when it is shown
};

struct SceneContent {
    std::filesystem::path path;
    std::uint64_t checksum = 0;
    SceneMeta meta{};
    std::string note;
    std::unique_ptr<ProgressiveMesh> mesh;   // null: the scene has none
    std::unique_ptr<TouchTool> tool;         // null: none
    std::unique_ptr<SurfaceDetail> detail;   // null: no surface, or one without a forest
    std::unique_ptr<SceneBoneContent> bone;  // null: none
    DensityGrid grid;                        // empty: none
    ContourScale scale;                      // what a level of it means
    std::vector<Structure> bodies;
    std::vector<Codebook> codebooks;       // one per body
    std::vector<std::vector<Bond>> bonds;  // one list per body
    Vec3 centre_model_m = Vec3::Zero();    // of what is drawn: origin of the scene frame
    double radius_m = 0.0;                 // of a ball about it that holds everything at home
    Vec3 box_min_model_m = Vec3::Zero(), box_max_model_m = Vec3::Zero();  // of the map
};

}  // namespace tact
