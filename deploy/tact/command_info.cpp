// tact info SCENE: all that another program needs to compute the same force from the same files.
// The force of a docking scene is spelled out here, of a surface in info_surface.cpp, of bone in
// info_drilling.cpp.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/info_drilling.hpp"
#include "deploy/tact/info_surface.hpp"
#include "deploy/tact/place.hpp"
#include "deploy/tact/run_report.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

// The force model in words and formulas; the numbers beside it are the letters.
constexpr const char* kFormulas[] = {
    "x_world = world_per_model * (x_model - centre_model_m); axes parallel, metres",
    "rho(x) = tricubic B-spline through (value - background) / sigma at the voxels of the felt map (see the "
    "note), where values outside the "
    "box "
    "are 0",
    "the spline interpolates: at a voxel it has the map's value; it is twice continuously differentiable",
    "a body at (c, q) has its points at r_i = c + q * p_i; at the file's place q is 1, c is "
    "file_place_com_model_m",
    "points: all atoms at level 1 (w_i their mass fractions), codebook vectors below, levels between two "
    "blended",
    "reduced correlation C = sum_i w_i rho(r_i), in sigma; the weights sum to 1",
    "force on the hand, world, N: F = energy_j_per_sigma / world_per_model * sum_i w_i grad rho(r_i), grad "
    "in "
    "sigma per model metre",
    "torque about c, world, N m: Q = energy_j_per_sigma * sum_i w_i (r_i - c) x grad rho(r_i)",
    "so both are the slope of the energy U = -energy_j_per_sigma * C over the hand's motion; --force-scale "
    "multiplies both",
    "option laplacian: rho is -s^2 Laplacian of (Gaussian * (value - background)), s = 0.225 * "
    "max(resolution, 20 angstrom), over a unit that gives the density's force range with the same gain",
    "option subtraction: the other bodies' simulated map (Gaussians of s = 0.225 * resolution, weight Z), "
    "scaled by least squares where it is above 5 % of its maximum, is taken out of value; not below the "
    "background",
    "option clash: U = F (sqrt(L^2 + D^2) - L) is added, D = world_per_model * depth of the overlap (soft "
    "maximum over atoms at the surface), F = 2 N, L = F / K, K such that seeded encounters stay below 300 "
    "N/m; F "
    "and K times the force scale",
    "the device gets F and Q behind the output chain (limits, slew, ramp-in); tact eval gives them before it",
};

json vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
json vec_a(const Vec3& v) { return vec(v / kAngstromM); }

json note_lines(const SceneFile& file) {
    json note = json::array();
    const std::string text = read_note(file);
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        if (end > at) note.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return note;
}

json docking_info(const SceneFile& file) {
    const Places places(file);
    const SceneMeta& m = places.meta();
    const DensityGrid& g = places.grid();
    json bodies = json::array();
    for (std::uint32_t i = 0; i < m.body_count; ++i) {
        const Structure& s = places.structures()[i];
        const Codebook book = read_codebook(file, i);
        json levels = json::array();
        for (const auto& l : book.levels)
            levels.push_back({{"vectors", l.size()},
                              {"edges", l.edges.size()},
                              {"rms_error_a", l.rms_error_m / kAngstromM}});
        bodies.push_back({{"name", s.name},
                          {"atoms", s.size()},
                          {"chains", s.chain_names.size()},
                          {"mass_u", s.mass_u},
                          {"file_place_com_model_m", vec(s.home_com_model_m)},
                          {"file_place_quat_xyzw", {0, 0, 0, 1}},
                          {"codebook", levels}});
    }
    return {{"world_per_model", m.world_per_model},
            {"centre_model_m", {m.centre_model_m[0], m.centre_model_m[1], m.centre_model_m[2]}},
            {"energy_j_per_sigma", m.energy_j_per_sigma},
            {"force_n_per_sigma_per_model_m", m.energy_j_per_sigma / m.world_per_model},
            {"map",
             {{"size", {g.size[0], g.size[1], g.size[2]}},
              {"spacing_a", vec_a(g.spacing_m)},
              {"origin_a", vec_a(g.origin_m)},
              {"mean", m.map_mean},
              {"sigma", m.map_sigma},
              {"background", m.map_background},
              {"contour", m.contour},
              {"contour_sigma", (m.contour - m.map_mean) / m.map_sigma},
              {"resolution_a", m.resolution_m > 0.0 ? json(m.resolution_m / kAngstromM) : json(nullptr)}}},
            {"bodies", bodies},
            {"formulas", kFormulas}};
}

json info(const std::filesystem::path& path) {
    const SceneFile file = SceneFile::open(path);
    const SceneMeta m = read_meta(file);
    char checksum[20];
    std::snprintf(checksum, sizeof checksum, "%016llx", static_cast<unsigned long long>(file.checksum()));
    const bool docking = m.kind == SceneKind::docking, surface = m.kind == SceneKind::surface;
    json all = docking ? docking_info(file) : surface ? surface_info(file) : drilling_info(file);
    all["path"] = std::filesystem::absolute(path).string();
    all["checksum"] = checksum;
    all["title"] = std::string(m.title);
    all["kind"] = docking ? "docking" : surface ? "surface" : "drilling";
    all["note"] = note_lines(file);
    return all;
}

std::string plain(const json& j) {
    if (j.is_string()) return j.get<std::string>();
    if (j.is_number_float()) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", j.get<double>());
        return text;
    }
    if (!j.is_array()) return j.dump(-1, ' ', false, json::error_handler_t::replace);
    std::string text;
    for (const auto& v : j) text += (text.empty() ? "" : ", ") + plain(v);
    return text;
}

bool flat(const json& object) {
    return std::none_of(object.begin(), object.end(), [](const json& v) { return v.is_structured(); });
}

void show(const json& j, const std::string& indent) {
    for (const auto& [key, value] : j.items()) {
        const bool rows = value.is_array() && !value.empty() && !value[0].is_number();
        if (!value.is_object() && !rows) {
            std::printf("%s%-*s  %s\n", indent.c_str(), static_cast<int>(30 - indent.size()), key.c_str(),
                        plain(value).c_str());
            continue;
        }
        std::printf("%s%s\n", indent.c_str(), key.c_str());
        if (value.is_object()) {
            show(value, indent + "  ");
            continue;
        }
        for (const auto& row : value) {
            std::string line;
            if (!row.is_object()) {
                line = plain(row);
            } else if (flat(row)) {
                for (const auto& [k, v] : row.items())
                    line += (line.empty() ? "" : ", ") + k + " " + plain(v);
            } else {
                show(row, indent + "  ");
                continue;
            }
            std::printf("%s  %s\n", indent.c_str(), line.c_str());
        }
    }
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "info", "what a baked scene holds: transform, gains, map, structures; or mesh, tree, forest");
    const auto scene = std::make_shared<std::filesystem::path>();
    const auto as_json = std::make_shared<bool>(false);
    command->add_option("SCENE", *scene, "file written by tact-prep")->required()->check(CLI::ExistingFile);
    command->add_flag("--json", *as_json, "print as JSON, for programs");
    command->callback([=, &exit_code] {
        const json j = info(*scene);
        if (*as_json)
            std::fputs(report_text(j).c_str(), stdout);
        else
            show(j, "");
        exit_code = 0;
    });
}

}  // namespace tact::launch
