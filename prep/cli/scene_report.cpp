#include "prep/cli/scene_report.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ipc/base/units.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/distance_field.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"

namespace tact {
namespace {

const char* kind_name(SceneKind kind) {
    switch (kind) {
        case SceneKind::docking:
            return "docking";
        case SceneKind::surface:
            return "surface";
        case SceneKind::drilling:
            return "drilling";
    }
    return "unknown";
}

nlohmann::ordered_json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

nlohmann::ordered_json scene_json(const SceneFile& file) {
    const SceneMeta meta = read_meta(file);
    char checksum[20];
    std::snprintf(checksum, sizeof checksum, "%016llx", static_cast<unsigned long long>(file.checksum()));
    nlohmann::ordered_json json{
        {"scene", file.name()},
        {"checksum", checksum},
        {"kind", kind_name(meta.kind)},
        {"title", meta.title},
        {"world_per_model", meta.world_per_model},
        {"centre_model_m", {meta.centre_model_m[0], meta.centre_model_m[1], meta.centre_model_m[2]}},
        {"energy_j_per_sigma", meta.energy_j_per_sigma},
        {"map_mean", meta.map_mean},
        {"map_sigma", meta.map_sigma},
        {"map_background", meta.map_background},
        {"contour", meta.contour},
        {"resolution_m", meta.resolution_m}};
    if (meta.kind == SceneKind::docking) {
        const DensityGrid grid = read_grid(file);
        json["grid"] = {
            {"size", grid.size}, {"origin_m", triple(grid.origin_m)}, {"spacing_m", triple(grid.spacing_m)}};
    }
    if (meta.kind == SceneKind::surface) {
        const SurfaceMesh surface = read_surface(file);
        json["surface"] = {{"vertices", surface.vertices()},
                           {"triangles", surface.triangles()},
                           {"closed", surface.closed()},
                           {"bytes", surface.bytes()}};
    }
    if (meta.kind == SceneKind::drilling) {
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
    if (file.count({'M', 'E', 'S', 'H'}) > 0) {
        const ProgressiveMesh mesh = read_mesh(file, 0);
        json["mesh"] = {{"vertices", mesh.vertices()},
                        {"vertices_min", mesh.vertices_min()},
                        {"triangles", mesh.triangles()}};
    }
    json["bodies"] = nlohmann::ordered_json::array();
    for (std::uint32_t i = 0; i < meta.body_count; ++i) {
        const Structure s = read_structure(file, i);
        nlohmann::ordered_json levels = nlohmann::ordered_json::array();
        for (const Codebook::Level& level : read_codebook(file, i).levels)
            levels.push_back({{"vectors", level.size()},
                              {"rms_error_m", level.rms_error_m},
                              {"edges", level.edges.size()}});
        json["bodies"].push_back({{"name", s.name},
                                  {"atoms", s.size()},
                                  {"mass_u", s.mass_u},
                                  {"chains", s.chain_names},
                                  {"home_com_model_m", triple(s.home_com_model_m)},
                                  {"codebook", levels}});
    }
    nlohmann::ordered_json note = nlohmann::ordered_json::array();
    std::istringstream lines(read_note(file));
    for (std::string line; std::getline(lines, line);) note.push_back(line);
    json["note"] = note;
    return json;
}

std::string scene_text(const SceneFile& file) {
    const nlohmann::ordered_json json = scene_json(file);
    std::ostringstream out;
    out << file.name() << ": " << json["kind"].get<std::string>() << " scene \""
        << json["title"].get<std::string>() << "\", checksum " << json["checksum"].get<std::string>() << '\n';
    out << read_note(file);
    return out.str();
}

}  // namespace tact
