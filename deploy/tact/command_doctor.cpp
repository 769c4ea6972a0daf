// tact doctor: checks the state of this machine and prints the fix of each problem.
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/doctor.hpp"
#include "deploy/tact/findings.hpp"
#include "deploy/tact/probe.hpp"
#include "ipc/version/version.hpp"

namespace tact::launch {
namespace {

int doctor(const std::string& session, bool as_json) {
    auto findings = try_surroundings(session);
    const auto machine = judge(read_machine());
    findings.insert(findings.end(), machine.begin(), machine.end());
    const auto input = judge_input(find_spacenav(), probe::joysticks());
    findings.insert(findings.end(), input.begin(), input.end());
    const bool good = none_fails(findings);
    if (as_json) {
        const nlohmann::json report = {
            {"ok", good}, {"version", version()}, {"findings", findings_json(findings)}};
        std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        print_findings(findings);
    }
    return good ? 0 : 1;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
    auto* const command =
        app.add_subcommand("doctor", "Check this machine; exit code 1: Tact cannot run here");
    const auto session = std::make_shared<std::string>("default");
    const auto as_json = std::make_shared<bool>(false);
    command->add_option("--session", *session, "Session name")->type_name("NAME")->capture_default_str();
    command->add_flag("--json", *as_json, "Print as JSON");
    command->callback([=, &exit_code] { exit_code = doctor(*session, *as_json); });
}

}  // namespace tact::launch
