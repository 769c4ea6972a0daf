// tact-prep: converts input files to one baked scene, or to one mesh.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "ipc/base/progress.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "prep/cli/bench_command.hpp"
#include "prep/cli/export_command.hpp"
#include "prep/cli/simplify_command.hpp"
#include "prep/cli/systems.hpp"
#include "prep/console/scene_report.hpp"
#include "prep/docking/dock_command.hpp"

namespace tact {
namespace {

void info(const std::string& scene, bool as_json) {
    const SceneFile file = SceneFile::open(scene);
    const SystemReport report = prep_system(read_meta(file).kind).report;
    const std::string text =
        as_json
            ? scene_json(file, report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
            : scene_text(file, report);
    std::fputs(text.c_str(), stdout);
}

void add_info(CLI::App& app) {
    const auto scene = std::make_shared<std::string>();
    const auto as_json = std::make_shared<bool>(false);
    CLI::App* const command = app.add_subcommand("info", "Check a baked scene and list its contents");
    command->add_option("scene", *scene, "Baked scene")->required();
    command->add_flag("--json", *as_json, "Print as JSON");
    command->callback([=] { info(*scene, *as_json); });
}

int run(int argc, char** argv) {
    CLI::App app(
        "Bake maps, structures, meshes and scans into scenes that tact-rt and tact-gui map into memory; "
        "simplify meshes.",
        "tact-prep");
    app.set_version_flag("--version", program_version("tact-prep"), "Print the version and exit");
    app.footer("Exit codes: 0 done; 1 error; 2 wrong usage; 130 cancelled by Ctrl-C, nothing written.");
    app.require_subcommand(1);
    const auto demo = std::make_shared<CLI::App>("Bake a synthetic scene, without input files", "demo");
    demo->require_subcommand(1);
    const auto examine = std::make_shared<CLI::App>(
        "Print as JSON what files are and what their import asks, without importing them", "examine");
    examine->require_subcommand(1);
    for (const PrepSystem& system : prep_systems()) {
        system.add_commands(app, *demo);
        if (system.add_examine != nullptr) system.add_examine(*examine);
    }
    app.add_subcommand(demo);
    app.add_subcommand(examine);
    CLI::App *simplify_parsed = nullptr, *bench_parsed = nullptr;
    const auto simplify_file = add_simplify(app, simplify_parsed);
    const auto bench = add_bench(app, bench_parsed);
    add_contour(app);
    add_info(app);
    add_export(app);
    if (const auto answered = manual::answer(app, "tact-prep", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (simplify_parsed->parsed()) simplify_file();
    if (bench_parsed->parsed()) bench();
    return 0;
}

}  // namespace
}  // namespace tact

int main(int argc, char** argv) {
    try {
        return tact::run(argc, argv);
    } catch (const tact::Cancelled&) {
        std::fputs("tact-prep: cancelled; nothing was written\n", stderr);
        return 130;
    } catch (const std::bad_alloc&) {
        std::fputs("tact-prep: out of memory\n  fix: free memory, or crop or bin the input\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tact-prep: %s\n", error.what());
    }
    return 1;
}
