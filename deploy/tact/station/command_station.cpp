// tact station: sets up a machine for a device, undoes that, and measures the machine.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/files.hpp"
#include "deploy/tact/station/command_station.hpp"
#include "deploy/tact/station/tools.hpp"
#include "deploy/tact/station/transaction.hpp"
#include "deploy/tact/station/verify.hpp"
#include "ipc/base/error.hpp"
#include "ipc/station/station_report.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

struct StationOptions {
    std::string root = "/";
    StationRequest request;
    bool dry_run = false, no_commands = false, force = false, as_json = false;
};

// Services are restarted only on the machine itself, not for another tree.
bool offline(const StationOptions& o) { return o.no_commands || std::filesystem::path(o.root) != "/"; }

void need_root(const StationOptions& o, const char* attempt) {
    if (std::filesystem::path(o.root) == "/" && geteuid() != 0)
        throw StartupError(attempt, "the command needs root",
                           "repeat the command with sudo; --dry-run shows the steps without root");
}

StationTools tools_of(const StationOptions& o, json& lines, json& commands) {
    StationTools tools;
    tools.root = o.root;
    tools.report = [&o, &lines](const std::string& line) {
        lines.push_back(line);
        if (!o.as_json) std::printf("%s\n", line.c_str());
        std::fflush(stdout);
    };
    tools.run = [&o, &commands, report = tools.report](const Command& command) {
        commands.push_back(command_text(command));
        if (!offline(o)) return run_command(command);
        report("    not run: only the files in " + o.root + " are changed");
        return 0;
    };
    return tools;
}

json planned_json(const StationPlan& plan, const std::filesystem::path& root) {
    json steps = json::array();
    for (const PlannedStep& step : plan.steps) {
        json files = json::array();
        json commands = json::array();
        for (const FileChange& change : changes_of(step, root)) files.push_back(change.path.string());
        for (const Command& command : step.commands) commands.push_back(command_text(command));
        steps.push_back({{"name", step.name},
                         {"purpose", step.purpose},
                         {"files", files},
                         {"commands", step.files.empty() || !files.empty() ? commands : json::array()}});
    }
    return steps;
}

void print_plan(const json& steps, const StationPlan& plan) {
    for (const std::string& remark : plan.remarks) std::printf("%s\n", remark.c_str());
    for (const json& step : steps) {
        std::printf("%s: %s\n", step["name"].get<std::string>().c_str(),
                    step["purpose"].get<std::string>().c_str());
        for (const json& file : step["files"]) std::printf("  write: %s\n", file.get<std::string>().c_str());
        for (const json& command : step["commands"])
            std::printf("  run: %s\n", command.get<std::string>().c_str());
        if (step["files"].empty() && step["commands"].empty()) std::printf("  already done\n");
    }
}

int setup(const StationOptions& o) {
    if (!o.dry_run) need_root(o, "set up this station");
    StationRequest request = o.request;
    const StationMachine machine = read_station_machine(o.root, offline(o));
    if (!offline(o) && !machine.kernel_installed) request.kernel_packages = kernel_packages_to_come();
    StationPlan plan = make_station_plan(machine, request);
    json report = {{"core", plan.cores.servo},
                   {"kernel_arguments", plan.kernel_arguments},
                   {"remarks", plan.remarks},
                   {"steps", planned_json(plan, o.root)}};
    if (o.dry_run) {
        if (!o.as_json) print_plan(report["steps"], plan);
        report["result"] = "dry run";
    } else {
        json lines = json::array(), commands = json::array();
        const StationTools tools = tools_of(o, lines, commands);
        for (const std::string& remark : plan.remarks) tools.report(remark);
        const SetupResult result = set_up_station(plan, tools);
        report["result"] = result == SetupResult::done ? "done" : "already so";
        report["commands"] = commands;
        if (!o.as_json)
            std::printf("%s\n", result == SetupResult::done
                                    ? "set up; restart the machine, then: sudo tact station verify"
                                    : "this station is already set up this way; nothing was changed");
    }
    if (o.as_json) std::printf("%s\n", report.dump(2).c_str());
    return 0;
}

int undo(const StationOptions& o) {
    need_root(o, "undo the set-up of this station");
    json lines = json::array(), commands = json::array();
    const bool undone = undo_station(tools_of(o, lines, commands), o.force);
    if (o.as_json)
        std::printf(
            "%s\n",
            json({{"result", undone ? "done" : "nothing to undo"}, {"commands", commands}}).dump(2).c_str());
    else
        std::printf("%s\n", undone ? "undone; restart the machine" : "nothing to undo");
    return 0;
}

struct VerifyCommand {
    VerifyOptions measure;
    double minutes = 1.0;
    std::string out = kStationReportPath;
    bool as_json = false;
};

// The kernel arguments of the set-up; only root may read the journal.
void add_wanted(VerifyMetrics& metrics) {
    try {
        if (const auto journal = read_journal("/")) metrics.arguments_wanted = journal->kernel_arguments;
    } catch (const StartupError& e) {
        std::fprintf(stderr, "tact: %s\n", e.what());
    }
}

int verify(const VerifyCommand& o) {
    // Check now, not after an hour of measuring.
    const auto folder = std::filesystem::absolute(o.out).parent_path();
    if (access(std::filesystem::exists(folder) ? folder.c_str() : folder.parent_path().c_str(), W_OK) != 0)
        throw StartupError("write " + o.out, last_error(),
                           "repeat the command with sudo, or give another file with --out");
    VerifyOptions measure = o.measure;
    measure.seconds = 60.0 * o.minutes;
    auto metrics =
        measure_station(measure, [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
    if (!metrics) return 130;
    add_wanted(*metrics);
    const VerifyLimits limits;
    const json report = station_report_json(*metrics, limits);
    const std::string text = report.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    write_whole(o.out, text);
    if (o.as_json) {
        std::fputs(text.c_str(), stdout);
    } else {
        for (const Check& c : judge_station(*metrics, limits))
            std::printf("%-4s  %-16s  %s\n", grade_text(c.grade), c.name.c_str(), c.text.c_str());
        std::printf("lateness p50 %.1f us, p99 %.1f us, p99.9 %.1f us, max %.1f us; cyclictest %s\n%s: %s\n",
                    metrics->p50_us, metrics->p99_us, metrics->p999_us, metrics->max_us,
                    metrics->cyclictest_text.c_str(), report["status"].get<std::string>().c_str(),
                    o.out.c_str());
    }
    return report["status"] == "fail" ? 1 : 0;
}

void add_root(CLI::App& command, StationOptions& o) {
    command.add_option("--root", o.root, "Folder that replaces / for all files; commands are not run")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory)
        ->capture_default_str();
    command.add_flag("--no-commands", o.no_commands,
                     "Change files only, and list the commands that are not run");
    command.add_flag("--json", o.as_json, "Report as JSON");
}

}  // namespace

void add_station(CLI::App& app, int& exit_code) {
    auto* const station = app.add_subcommand(
        "station",
        "Set up this machine for a device (setup), undo the set-up (undo), measure the machine (verify)");
    station->require_subcommand(1);
    const auto o = std::make_shared<StationOptions>();
    if (const char* const user = std::getenv("SUDO_USER")) o->request.user = user;

    auto* const setup_command =
        station->add_subcommand("setup",
                                "Set up a real-time kernel, a core for the servo, rights and processor "
                                "settings; tact station undo reverts all of it");
    add_root(*setup_command, *o);
    setup_command->add_flag("--dry-run", o->dry_run, "Print the steps and change nothing");
    setup_command
        ->add_option("--core", o->request.core,
                     "Processor core for the servo, kept free with all of its hardware threads; default: the "
                     "last core")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    setup_command
        ->add_option("--user", o->request.user, "User who gets the rights; default: the user of sudo")
        ->type_name("NAME");
    setup_command
        ->add_option("--skip", o->request.skip,
                     "Step to omit: kernel, groups, rights, tuning, service or kernel-arguments")
        ->type_name("STEP");
    setup_command->callback([o, &exit_code] { exit_code = setup(*o); });

    const auto v = std::make_shared<VerifyCommand>();
    auto* const verify_command = station->add_subcommand(
        "verify",
        "Measure the machine with cyclictest and with the controller on an emulated device, and write a "
        "report; stop other controllers first; exit code 1: the machine fails");
    verify_command->add_option("--minutes", v->minutes, "Duration of the measurement (minutes)")
        ->type_name("N")
        ->check(CLI::Range(0.01, 10000.0))
        ->capture_default_str();
    verify_command->add_option("--out", v->out, "Report file, read by tact-rt and tact metrics")
        ->type_name("FILE")
        ->capture_default_str();
    verify_command
        ->add_option("--scene", v->measure.scene, "Baked scene to run; default: a synthetic docking scene")
        ->type_name("SCENE")
        ->check(CLI::ExistingFile);
    verify_command
        ->add_option("--config", v->measure.config, "Configuration of tact-rt, with an emulated device")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    verify_command
        ->add_option("--core", v->measure.core,
                     "Processor core of the servo; default: the last isolated core, otherwise the last core")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    verify_command->add_flag("--json", v->as_json, "Print the report as JSON");
    verify_command->callback([v, &exit_code] { exit_code = verify(*v); });

    auto* const undo_command = station->add_subcommand(
        "undo",
        "Restore every file as it was before the set-up, byte for byte, also after an interrupted set-up");
    add_root(*undo_command, *o);
    undo_command->add_flag("--force", o->force, "Also restore files that were changed since the set-up");
    undo_command->callback([o, &exit_code] { exit_code = undo(*o); });
}

}  // namespace tact::launch
