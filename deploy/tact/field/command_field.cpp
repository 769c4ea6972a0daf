// tact field FILE: bakes a potential field once, then runs it.
// tact demo field: a hand wanders in the field of two opposite charges.
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/field/field.hpp"
#include "deploy/tact/run.hpp"
#include "ipc/scene/field/field.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact::launch {
namespace {

constexpr PassedOption kFieldPrep[] = {
    {"--unit", "m|cm|mm|um|nm|a", "Unit of length in the field file (a: angstrom); default mm"},
    {"--size-mm", "MM", "Longest edge of the field's box in the workspace (mm); default 150"},
    {"--force-max", "N", "Force at the largest slope of the field (N); default 2"},
    {"--stiffness-max", "N/M",
     "Maximum stiffness of the field (N/m); the gain is reduced to keep it; default 800"},
    {"--probe-radius-mm", "MM",
     "Radius of the ball over which the field is averaged (mm); 0: a point; default 2"},
    {"--value-unit", "TEXT", "Unit of the values, for display; default: none"},
};

constexpr const char* kFieldFormulas[] = {
    "x_world = world_per_model * (x_model - centre_model_m); axes parallel, metres",
    "F = -force_n_m_per_unit * mean over the ball of grad(phi); grad per model metre, world axes, N",
    "phi: tricubic B-spline through the values; outside the box F fades to zero over four grid steps",
};

// Without a device and an explicit choice, the emulated hand wanders, because a field moves no hand.
void let_the_hand_wander(RunOptions& options) {
    if (hand_is_free(options)) options.add_for_scene({"--hand", "wander"});
}

struct FieldOptions {
    std::filesystem::path file;
    BakedRun baked;
};

}  // namespace

void add_field(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("field", "Feel a potential field on a grid");
    const auto o = std::make_shared<FieldOptions>();
    command
        ->add_option("FILE", o->file, "Potential field: CSV with x,y,z,value in each line, or NRRD, also .gz")
        ->required()
        ->check(CLI::ExistingFile);
    add_baked_run_options(*command, kFieldPrep, o->baked);
    command->callback([o, &exit_code] {
        const BakeRequest request{.inputs = {o->file},
                                  .words = {"field", std::filesystem::absolute(o->file)},
                                  .options = o->baked.prep};
        let_the_hand_wander(o->baked.run);
        exit_code = bake_and_run(request, o->baked);
    });
}

void add_field_demo(CLI::App& demo, int& exit_code) {
    auto* const command = demo.add_subcommand("field", "A hand wanders in the field of two opposite charges");
    const auto baked = std::make_shared<BakedRun>();
    add_demo_run_options(*command, *baked);
    command->callback([baked, &exit_code] {
        let_the_hand_wander(baked->run);
        exit_code = bake_and_run({.inputs = {}, .words = {"demo", "field"}, .options = {}}, *baked);
    });
}

nlohmann::json field_info(const SceneFile& file) {
    const SceneMeta m = read_meta(file);
    const FieldMeta f = read_field_meta(file);
    const auto vec = [](const double(&v)[3]) { return nlohmann::json{v[0], v[1], v[2]}; };
    return {{"world_per_model", m.world_per_model},
            {"centre_model_m", vec(m.centre_model_m)},
            {"box_low_model_m", vec(f.box_low_m)},
            {"box_high_model_m", vec(f.box_high_m)},
            {"unit", f.unit},
            {"low", f.low},
            {"high", f.high},
            {"force_n_m_per_unit", f.force_n_m_per_unit},
            {"force_n_max", f.force_n_max},
            {"stiffness_n_m", f.stiffness_n_m},
            {"probe_radius_model_m", f.probe_radius_m},
            {"formulas", kFieldFormulas}};
}

std::unique_ptr<SystemRun> open_field_run(const SceneFile& /*scene*/) {
    return std::make_unique<SystemRun>();
}

std::string field_summary(const nlohmann::json& /*report*/) { return {}; }

}  // namespace tact::launch
