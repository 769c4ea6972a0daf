#include "prep/cli/drill_command.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "prep/cli/console.hpp"
#include "prep/cli/target.hpp"
#include "prep/synthetic/temporal_bone.hpp"
#include "prep/volume/bake_bone.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct DrillSettings {
    std::string scene;
    TemporalBone made;
    double made_voxel_mm = 0.0;
    bool json = false;
};

// Volume, labels, what is computed from them, the sections and the file's bytes, the most that lie side by side.
void say_memory(double voxels, double bytes_a_voxel) {
    std::fprintf(stderr, "%.0f million voxels; about %.1f GB of memory are needed\n", 1e-6 * voxels,
                 1e-9 * voxels * bytes_a_voxel);
}

BoneInput drill_made(const DrillSettings& o, Console& console) {
    BoneInput input;
    TemporalBone made = o.made;
    made.voxel_m = o.made_voxel_mm > 0.0 ? 1e-3 * o.made_voxel_mm : 0.05 / made.voxels;
    const double edge = made.voxels;
    say_memory(edge * edge * edge, 6.0);
    const Progress progress = console.progress();
    input.bone = make_temporal_bone(
        made, [&](double fraction, const char* what) { return progress(0.5 * fraction, what); });
    input.title = "synthetic temporal bone, right";
    input.note = {"bone: made by tact-prep, a right temporal bone of seed " + std::to_string(made.seed)};
    return input;
}

void drill(const DrillSettings& o) {
    check_target("write scene", o.scene, {});
    const auto started = std::chrono::steady_clock::now();
    Console console;
    BoneInput input = drill_made(o, console);
    input.note.insert(input.note.begin(), "made by: tact-prep " TACT_VERSION);
    const BoneBricks bricks = input.bone.bricks;
    const std::size_t structures = input.bone.structure.size();
    SceneWriter out;
    const BakedBone baked = bake_bone(std::move(input), out, console.progress());
    report(console.progress(), 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (o.json) {
        const nlohmann::ordered_json json{{"scene", o.scene},
                                          {"size", bricks.size},
                                          {"voxel_m", bricks.voxel_m},
                                          {"bone_voxels", baked.bone_voxels},
                                          {"bone_m3", baked.bone_m3},
                                          {"structures", structures},
                                          {"distance_fields", baked.distance_fields},
                                          {"seconds", seconds}};
        std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        std::printf("%s%s: %.1f MB in %.1f s\n", baked.note.c_str(), o.scene.c_str(),
                    static_cast<double>(fs::file_size(o.scene)) * 1e-6, seconds);
    }
}

}  // namespace

void add_drill(CLI::App& app, CLI::App& demo) {
    static_cast<void>(app);
    const auto o = std::make_shared<DrillSettings>();
    CLI::App* const made = demo.add_subcommand("drill", "a temporal bone of the right side");
    made->add_option("-o,--output", o->scene, "the scene to write")->required();
    made->add_option("--voxels", o->made.voxels, "along each axis")
        ->check(CLI::Range(16U, 1024U))
        ->capture_default_str();
    made->add_option("--voxel-mm", o->made_voxel_mm, "edge of one; 0: the whole is 50 mm wide")
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
    made->add_option("--seed", o->made.seed, "of the air cells and the roughness")->capture_default_str();
    made->add_flag("--json", o->json, "print what was baked as JSON");
    made->callback([o] { drill(*o); });
}

}  // namespace tact
