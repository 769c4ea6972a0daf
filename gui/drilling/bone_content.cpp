#include "gui/drilling/bone_content.hpp"

#include <utility>

#include "gui/drilling/bone_field.hpp"

namespace tact {

std::unique_ptr<SystemContent> read_bone_content(SceneFile file, SceneContent& content) {
    const BoneVolumeView volume = read_bone_volume(file);
    const BoneBricks& bricks = volume.bricks;
    content.box_min_model_m = bricks.to_model(Vec3::Constant(-0.5));
    content.box_max_model_m =
        bricks.to_model(Vec3(bricks.size[0], bricks.size[1], bricks.size[2]).array() - 0.5);
    BoneLabelsView labels;
    if (has_bone_labels(file)) labels = read_bone_labels(file, bricks);
    std::vector<DistanceField> distances = read_distance_fields(file, labels.structure.size());
    const std::optional<PatientFrame> patient = read_patient_frame(file);
    auto bone =
        std::make_unique<BoneContent>(std::move(file), volume, std::move(labels), std::move(distances));
    bone->patient = patient;
    const BoneField field(bone->volume, bone->labels, bone->volume);
    bone->free_cells.assign(field.free_cells().begin(), field.free_cells().end());
    return bone;
}

}  // namespace tact
