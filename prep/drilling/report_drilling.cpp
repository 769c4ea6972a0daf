#include "prep/drilling/report_drilling.hpp"

#include <nlohmann/json.hpp>

#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"

namespace tact {
namespace {

nlohmann::ordered_json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void report_drilling(const SceneFile& file, nlohmann::ordered_json& json) {
    const BoneVolumeView bone = read_bone_volume(file);
    json["bone"] = {{"size", bone.bricks.size},
                    {"voxel_m", bone.bricks.voxel_m},
                    {"origin_m", triple(bone.bricks.origin_m)}};
    if (bone.has_hu()) json["bone"]["hu_at_0_and_255"] = {bone.hu_at_0, bone.hu_at_255};
    json["structures"] = nlohmann::ordered_json::array();
    if (has_bone_labels(file)) {
        const BoneLabelsView labels = read_bone_labels(file, bone.bricks);
        for (const BoneStructure& s : labels.structure)
            json["structures"].push_back({{"name", s.name}, {"rgba", s.rgba}, {"critical", s.critical}});
        for (const DistanceField& f : read_distance_fields(file, labels.structure.size()))
            json["structures"][f.label - 1]["distance"] = {{"spacing_m", f.spacing_m},
                                                           {"error_m", f.error_m}};
    }
}

}  // namespace tact
