// tact reproduce: the seeds' figures on this machine.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/reproduce_governor.hpp"

namespace tact::launch {

void add_reproduce(CLI::App& app, int& exit_code) {
    auto* const reproduce =
        app.add_subcommand("reproduce", "run the seeds' experiments again, on this machine");
    reproduce->require_subcommand(1);
    auto* const governor = reproduce->add_subcommand(
        "governor", "the force rate with and without the law, with and without an external load");
    const auto e = std::make_shared<GovernorExperiment>();
    governor->add_option("--out", e->out, "folder for CSV, PNG and JSON")->required();
    governor->add_option("--core", e->core, "the core that all share; -1: the last")
        ->check(CLI::Range(-1, 1023));
    governor->add_option("--fps-max", e->fps_max, "pictures a second, at most")
        ->check(CLI::Range(1.0, 240.0))
        ->capture_default_str();
    governor->add_option("--goal", e->goal_hz, "under load, in Hz; 0: from a measurement")
        ->check(CLI::Range(0.0, 1e6));
    governor->add_flag("--quick", e->quick, "seconds instead of a minute and a half; shows that it works");
    governor->callback([e, &exit_code] { exit_code = reproduce_governor(*e); });
}

}  // namespace tact::launch
