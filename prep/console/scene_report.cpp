#include "prep/console/scene_report.hpp"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {
namespace {

nlohmann::ordered_json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

nlohmann::ordered_json scene_json(const SceneFile& file, SystemReport add_system) {
    const SceneMeta meta = read_meta(file);
    char checksum[20];
    std::snprintf(checksum, sizeof checksum, "%016llx", static_cast<unsigned long long>(file.checksum()));
    nlohmann::ordered_json json{
        {"scene", file.name()},
        {"checksum", checksum},
        {"kind", scene_kind_text(meta.kind)},
        {"title", meta.title},
        {"world_per_model", meta.world_per_model},
        {"centre_model_m", {meta.centre_model_m[0], meta.centre_model_m[1], meta.centre_model_m[2]}},
        {"energy_j_per_sigma", meta.energy_j_per_sigma},
        {"map_mean", meta.map_mean},
        {"map_sigma", meta.map_sigma},
        {"map_background", meta.map_background},
        {"contour", meta.contour},
        {"resolution_m", meta.resolution_m}};
    add_system(file, json);
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

std::string scene_text(const SceneFile& file, SystemReport add_system) {
    const nlohmann::ordered_json json = scene_json(file, add_system);
    std::ostringstream out;
    out << file.name() << ": " << json["kind"].get<std::string>() << " scene \""
        << json["title"].get<std::string>() << "\", checksum " << json["checksum"].get<std::string>() << '\n';
    out << read_note(file);
    return out.str();
}

void print_written_scene(const std::string& scene, const std::string& note, double seconds, bool as_json,
                         const nlohmann::ordered_json& report) {
    if (as_json) {
        nlohmann::ordered_json json{{"scene", scene}};
        json.update(report);
        json["seconds"] = seconds;
        std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        std::printf("%s%s: %.1f MB in %.1f s\n", note.c_str(), scene.c_str(),
                    static_cast<double>(std::filesystem::file_size(scene)) * 1e-6, seconds);
    }
}

}  // namespace tact
