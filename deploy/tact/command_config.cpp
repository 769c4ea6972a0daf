// tact config check FILE: becomes tact-rt, which has the only reader of the configuration.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/exec.hpp"

namespace tact::launch {

void add_config(CLI::App& app) {
    auto* const config = app.add_subcommand("config", "Check a configuration file of the controller");
    config->require_subcommand(1);
    auto* const check =
        config->add_subcommand("check",
                               "Check keys, types, ranges, drivers and the core of the servo thread, without "
                               "a scene and without opening a device; exit code 1: the file has problems");
    const auto file = std::make_shared<std::string>();
    const auto as_json = std::make_shared<bool>(false);
    check
        ->add_option("file", *file,
                     "Configuration (TOML); deploy/tact.toml (/etc/tact/tact.toml) lists every key")
        ->type_name("FILE")
        ->required();
    check->add_flag("--json", *as_json, "Print the problems and the value of every key as JSON");
    check->callback([=] {
        std::vector<std::string> words{"--check-config=" + *file};
        if (*as_json) words.emplace_back("--json");
        exec_program("tact-rt", std::move(words));
    });
}

}  // namespace tact::launch
