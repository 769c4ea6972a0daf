#include "deploy/tact/drilling/drilling.hpp"

#include <array>

#include <nlohmann/json.hpp>

#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/drilling/drill_model.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr const char* kDrillingFormulas[] = {
    ("x_world = world_per_model * (x_model - centre_model_m); axes parallel, metres; voxel (0, 0, 0) "
     "is centred on origin_model_m"),
    ("m0 = integral of density / 255 over the burr, m1 = the same times the position from its centre; "
     "metres"),
    ("x_patient_mm = origin_lps_mm + 1000 * (x_model[0] * direction of x + x_model[1] * that of y + "
     "x_model[2] * that of z); LPS: to the patient's left, back and head"),
    "x^2 - x^3 / 3 = m0 / (pi R^3), x = h / R, h the penetration",
    ("elastic: c_e R^2 x^(3/2) away from the bone, along -m1 / |m1|; N; c_e is elastic_pa, or if "
     "depth_at_1_n_m is above 0, the value that holds the ball with 1 N at that depth on a flat surface (or "
     "at R / 2)"),
    ("friction: c_mu R^2 x (m1 / m0) x omega, limited smoothly to friction_share of the elastic force; "
     "impact: - c_i R^2 x V; N"),
    ("erosion: d rho / dt = -a (1 - (r / R)^2) rho inside the burr, a = rate_per_s at the speed "
     "rate_at_rad_s and proportional to the speed, and soft times as fast in the softest bone, "
     "linear between"),
    ("size and shape of the burr, its speed and the force limit are settings of the controller, not "
     "of the scene"),
};

}  // namespace

json drilling_info(const SceneFile& file) {
    const SceneMeta m = read_meta(file);
    const BoneVolumeView bone = read_bone_volume(file);
    std::array<std::size_t, 256> of{};
    for (const std::uint8_t d : bone.density) ++of[d];
    std::size_t solid = 0;
    double mass = 0.0;
    for (std::size_t d = 1; d < of.size(); ++d) {
        solid += of[d];
        mass += static_cast<double>(of[d] * d) / 255.0;
    }
    const auto& size = bone.bricks.size;
    const double voxel_mm3 = 1e9 * bone.bricks.voxel_m * bone.bricks.voxel_m * bone.bricks.voxel_m;
    json structures = json::array();
    if (has_bone_labels(file)) {
        const BoneLabelsView labels = read_bone_labels(file, bone.bricks);
        std::array<std::size_t, 256> voxels{};
        for (const std::uint8_t l : labels.label) ++voxels[l];
        const std::vector<DistanceField> fields = read_distance_fields(file, labels.structure.size());
        for (std::size_t i = 0; i < labels.structure.size(); ++i) {
            json row{{"label", i + 1},
                     {"name", labels.structure[i].name},
                     {"critical", labels.structure[i].critical},
                     {"volume_mm3", static_cast<double>(voxels[i + 1]) * voxel_mm3},
                     {"distance_error_mm", nullptr}};
            for (const DistanceField& f : fields)
                if (f.label == i + 1) row["distance_error_mm"] = 1e3 * f.error_m;
            structures.push_back(row);
        }
    }
    json patient;  // null: the scan states no orientation
    if (const auto frame = read_patient_frame(file)) {
        json axes = json::object();
        for (int a = 0; a < 3; ++a)
            axes[std::string(1, "xyz"[a])] = {
                {"to", patient_letters(frame->axes.col(a))},
                {"direction_lps",
                 {frame->axes(0, a) + 0.0, frame->axes(1, a) + 0.0, frame->axes(2, a) + 0.0}}};  // no -0
        patient = {{"model_axes", axes},
                   {"origin_lps_mm", {frame->origin_mm.x(), frame->origin_mm.y(), frame->origin_mm.z()}}};
    }
    const DrillSettings settings;
    const BurrLaw& law = settings.law;
    return {
        {"world_per_model", m.world_per_model},
        {"centre_model_m", {m.centre_model_m[0], m.centre_model_m[1], m.centre_model_m[2]}},
        {"bone",
         {{"size_voxels", {size[0], size[1], size[2]}},
          {"voxel_mm", 1e3 * bone.bricks.voxel_m},
          {"origin_model_m", {bone.bricks.origin_m.x(), bone.bricks.origin_m.y(), bone.bricks.origin_m.z()}},
          {"hu_at_0", bone.has_hu() ? json(bone.hu_at_0) : json(nullptr)},
          {"hu_at_255", bone.has_hu() ? json(bone.hu_at_255) : json(nullptr)},
          {"bone_voxels", solid},
          {"solid_volume_mm3", mass * voxel_mm3},
          {"bytes", bone.bricks.bytes()}}},
        {"patient", patient},
        {"structures", structures},
        {"elastic_pa", law.elastic_pa},
        {"friction_n_s_m3", law.friction_n_s_m3},
        {"impact_n_s_m3", law.impact_n_s_m3},
        {"rate_per_s", settings.rate_per_s},
        {"rate_at_rad_s", settings.rate_at_rad_s},
        {"soft", settings.soft},
        {"formulas", kDrillingFormulas}};
}

}  // namespace tact::launch
