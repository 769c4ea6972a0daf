// tact doctor: what of this machine is as Tact wants it, and the mend of what is not.
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/doctor.hpp"

namespace tact::launch {
namespace {

const char* level_text(FindingLevel level) {
    switch (level) {
        case FindingLevel::ok:
            return "ok";
        case FindingLevel::warn:
            return "warn";
        case FindingLevel::fail:
            return "fail";
    }
    return "unknown";
}

int doctor(const std::string& session, bool as_json) {
    auto findings = try_surroundings(session);
    const auto machine = judge(read_machine());
    findings.insert(findings.end(), machine.begin(), machine.end());
    bool good = true;
    nlohmann::json rows = nlohmann::json::array();
    for (const Finding& f : findings) {
        good &= f.level != FindingLevel::fail;
        rows.push_back(
            {{"name", f.name}, {"level", level_text(f.level)}, {"says", f.says}, {"mend", f.mend}});
        if (as_json) continue;
        std::printf("%-4s  %-14s  %s\n", level_text(f.level), f.name.c_str(), f.says.c_str());
        if (!f.mend.empty()) std::printf("%22smend: %s\n", "", f.mend.c_str());
    }
    if (as_json) {
        const nlohmann::json report = {{"ok", good}, {"version", TACT_VERSION}, {"findings", rows}};
        std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    }
    return good ? 0 : 1;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
    auto* const command =
        app.add_subcommand("doctor", "look at this machine; exit code 1: Tact will not run here");
    const auto session = std::make_shared<std::string>("default");
    const auto as_json = std::make_shared<bool>(false);
    command->add_option("--session", *session, "name of the session")
        ->type_name("NAME")
        ->capture_default_str();
    command->add_flag("--json", *as_json, "for programs");
    command->callback([=, &exit_code] { exit_code = doctor(*session, *as_json); });
}

}  // namespace tact::launch
