// Baked bone and the structure of each of its voxels, memory-mapped.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gui/render/scene_content.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/bone/patient_frame.hpp"

namespace tact {

class BoneContent : public SystemContent {
public:
    BoneContent(SceneFile mapped, const BoneVolumeView& as_baked, BoneLabelsView of_voxels,
                std::vector<DistanceField> to_structures)
        : file(std::move(mapped)),
          volume(as_baked),
          labels(std::move(of_voxels)),
          distances(std::move(to_structures)) {}

    SceneFile file;
    BoneVolumeView volume;
    BoneLabelsView labels;                 // none: no structures
    std::vector<DistanceField> distances;  // to the critical structures
    std::optional<PatientFrame> patient;
    std::vector<std::uint8_t> free_cells;  // as baked (BoneField); empty: measured when first shown
};

// Throws StartupError naming the file.
[[nodiscard]] std::unique_ptr<SystemContent> read_bone_content(SceneFile file, SceneContent& content);

}  // namespace tact
