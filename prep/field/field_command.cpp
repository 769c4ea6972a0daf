#include "prep/field/field_command.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/printable.hpp"
#include "ipc/version/version.hpp"
#include "prep/console/console.hpp"
#include "prep/console/scene_report.hpp"
#include "prep/console/target.hpp"
#include "prep/field/bake_field.hpp"
#include "prep/field/charges.hpp"
#include "prep/field/import_field.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct Unit {
    const char* name;
    double metres;
};
constexpr Unit kUnits[] = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}, {"a", 1e-10}};

struct FieldSettings {
    std::string file, scene, unit = "mm", value_unit;
    double size_mm = 150.0, force_n_max = 2.0, stiffness_n_m_max = 800.0, probe_radius_mm = 2.0;
    std::uint32_t points = 65;
    bool json = false;
};

FieldInput from_file(const FieldSettings& o) {
    const auto* const unit =
        std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& u) { return o.unit == u.name; });
    ImportedField in = import_field(o.file, unit->metres);
    FieldInput input;
    input.title = fs::path(o.file).filename().string();
    input.grid = std::move(in.grid);
    input.note = {"field: " + fs::absolute(o.file).string(), "field format: " + in.format,
                  "field unit of length: " + o.unit};
    for (const std::string& line : in.notes) input.note.push_back("field: " + line);
    for (std::string& line : input.note) line = printable(line);
    return input;
}

FieldInput from_code(const FieldSettings& o) {
    FieldInput input;
    input.title = "two opposite charges";
    input.grid = two_charges_grid({}, o.points);
    input.note = {"field: two opposite charges, made by tact-prep"};
    return input;
}

void bake(const FieldSettings& o, bool made) {
    std::vector<std::string> inputs;
    if (!made) inputs.push_back(o.file);
    check_target("write scene", o.scene, inputs);
    const auto started = std::chrono::steady_clock::now();
    Console console;
    const Progress progress = console.progress();
    report(progress, 0.0, "reading the field");
    FieldInput input = made ? from_code(o) : from_file(o);
    input.note.insert(input.note.begin(), "made by: " + program_version("tact-prep"));
    input.unit = o.value_unit;
    input.size_m = 1e-3 * o.size_mm;
    input.force_n_max = o.force_n_max;
    input.stiffness_n_m_max = o.stiffness_n_m_max;
    input.probe_radius_m = 1e-3 * o.probe_radius_mm;
    SceneWriter out;
    const BakedField baked = bake_field(input, out, part(progress, 0.1, 0.98));
    report(progress, 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    print_written_scene(o.scene, baked.note, seconds, o.json,
                        {{"points", input.grid.size},
                         {"low", baked.field.low},
                         {"high", baked.field.high},
                         {"force_n_m_per_unit", baked.field.force_n_m_per_unit},
                         {"force_n_max", baked.field.force_n_max},
                         {"stiffness_n_m", baked.field.stiffness_n_m},
                         {"world_per_model", baked.meta.world_per_model},
                         {"display_vertices", baked.vertices}});
}

}  // namespace

void add_field(CLI::App& app, CLI::App& demo) {
    const auto o = std::make_shared<FieldSettings>();
    const auto both = [&](CLI::App* sub) {
        sub->add_option("-o,--output", o->scene, "Scene file to write")->required()->type_name("SCENE");
        sub->add_option("--size-mm", o->size_mm, "Longest edge of the field's box in the workspace (mm)")
            ->check(CLI::Range(1.0, 10000.0))
            ->capture_default_str();
        sub->add_option("--force-max", o->force_n_max, "Force at the largest slope of the field (N)")
            ->check(CLI::Range(0.01, 20.0))
            ->capture_default_str();
        sub->add_option("--stiffness-max", o->stiffness_n_m_max,
                        "Maximum stiffness of the field (N/m); the gain is reduced to keep it")
            ->check(CLI::Range(1.0, 10000.0))
            ->capture_default_str();
        sub->add_option(
               "--probe-radius-mm", o->probe_radius_mm,
               "Radius in the workspace of the ball over which the field is averaged (mm); 0: a point")
            ->check(CLI::Range(0.0, 50.0))
            ->capture_default_str();
        sub->add_option("--value-unit", o->value_unit, "Unit of the values, for display; default: none");
        sub->add_flag("--json", o->json, "Print the properties of the baked scene as JSON");
    };
    CLI::App* const file = app.add_subcommand("field", "Bake a potential field from values on a grid");
    file->add_option("field", o->file,
                     "Potential field: CSV with x,y,z,value in each line, or NRRD, also .gz")
        ->required();
    file->add_option("--unit", o->unit, "Unit of length in the field file (a: angstrom)")
        ->check(CLI::IsMember({"m", "cm", "mm", "um", "nm", "a"}))
        ->capture_default_str();
    both(file);
    file->callback([o] { bake(*o, false); });
    CLI::App* const made = demo.add_subcommand("field", "Bake the potential of two opposite charges");
    made->add_option("--points", o->points, "Number of grid points along an edge")
        ->check(CLI::Range(kFieldPointsMin, kFieldPointsMax))
        ->capture_default_str();
    both(made);
    made->callback([o] { bake(*o, true); });
}

}  // namespace tact
