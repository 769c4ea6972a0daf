#include "deploy/tact/docking/save_fit.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/run_report.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact::launch {
namespace {

// Writing a few hundred thousand atoms for each of sixteen bodies takes seconds.
constexpr auto kExportLimit = std::chrono::minutes(10);

}  // namespace

bool structures_have_sources(const SceneFile& scene) {
    return read_note(scene).find("\nstructure check: ") != std::string::npos;
}

void check_save_folder(const std::filesystem::path& folder) {
    const std::string attempt = "saving to " + folder.string();
    std::error_code ignored;
    if (std::filesystem::exists(folder, ignored)) {
        if (!std::filesystem::is_directory(folder, ignored))
            throw StartupError(attempt, "the path is not a folder", "give another name to --save");
        if (!std::filesystem::is_empty(folder, ignored))
            throw StartupError(attempt, "the folder is not empty, and existing files are never overwritten",
                               "give another name to --save, or empty the folder");
    }
}

nlohmann::json amplitudes_json(std::span<const float> amplitude_m) {
    nlohmann::json list = nlohmann::json::array();
    for (const float a : amplitude_m) list.push_back(static_cast<double>(a) / kAngstromM);
    return list;
}

nlohmann::json poses_json(const BodiesTopic& bodies, const ShapesTopic* shapes,
                          const std::vector<Structure>& structures) {
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t i = 0; i < std::min<std::size_t>(bodies.count, kBodiesMax); ++i) {
        const BodyPlace& b = bodies.body[i];
        const double* const p = b.pos_model_m;
        const double* const q = b.quat_model_body_xyzw;
        const bool sound = b.structure < structures.size() && Vec3(p).allFinite() &&
                           std::abs(Quat(q[3], q[0], q[1], q[2]).norm() - 1.0) < 1e-3;
        if (!sound) continue;
        list.push_back({{"id", b.id},
                        {"structure", b.structure},
                        {"name", structures[b.structure].name},
                        {"pos_model_a", {p[0] / kAngstromM, p[1] / kAngstromM, p[2] / kAngstromM}},
                        {"quat_model_body_xyzw", {q[0], q[1], q[2], q[3]}}});
        if (shapes == nullptr) continue;
        if (const auto bent = amplitudes_of(*shapes, b.id); !bent.empty())
            list.back()["mode_amplitudes_a"] = amplitudes_json(bent);
    }
    return {{"bodies", list}};
}

void save_fit(const SaveRequest& request, const nlohmann::json& poses, Signals& signals) {
    const std::filesystem::path& folder = request.folder;
    const auto file = folder / "poses.json";
    write_whole(file, report_text(poses));
    std::printf("wrote %s\n", file.c_str());
    std::fflush(stdout);
    signals.wait(0);  // discards a second Ctrl-C, which was meant for the run, not for the save
    ChildSettings settings;
    settings.arguments = {"export", request.scene.string(), "--poses", file.string(), "-o", folder.string()};
    Child child("tact-prep", find_program("tact-prep", request.programs), settings);
    const Instant end = Monotonic::now() + kExportLimit;
    std::string why;
    while (!child.poll()) {
        const int asked = signals.wait(50);
        if (!why.empty()) continue;
        if (asked != 0) why = std::string("tact-prep was ended by ") + sigdescr_np(asked);
        if (asked == 0 && Monotonic::now() >= end) why = "tact-prep did not end within ten minutes";
        if (!why.empty()) child.stop();
    }
    const Ending& ending = *child.poll();
    if (!ending.clean())
        throw StartupError("saving to " + folder.string(), why.empty() ? "tact-prep " + ending.text() : why,
                           "see the messages of tact-prep above; the poses are in " + file.string() +
                               ", from which tact-prep export writes the structures");
}

}  // namespace tact::launch
