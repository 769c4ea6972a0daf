// The commands of `tact` for all systems; one file each, named command_<name>.cpp. deploy/tact/systems has the commands
// of single systems.
//
// A command adds itself to the parser with a callback that sets `exit_code`.
#pragma once

#include <CLI/CLI.hpp>

namespace tact::launch {

void add_demo(CLI::App& app, int& exit_code);  // tact demo dock, ...
void add_run(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_config(CLI::App& app);
void add_record(CLI::App& app);
void add_replay(CLI::App& app, int& exit_code);
void add_metrics(CLI::App& app, int& exit_code);
void add_igtl(CLI::App& app, int& exit_code);
void add_status(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_probe(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app);
void add_certify(CLI::App& app);
void add_reproduce(CLI::App& app);

}  // namespace tact::launch
