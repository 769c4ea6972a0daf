// tact demo: one demo per system, without files or devices.
#include "deploy/tact/commands.hpp"
#include "deploy/tact/systems.hpp"

namespace tact::launch {

void add_demo(CLI::App& app, int& exit_code) {
    auto* const demo = app.add_subcommand("demo", "Demonstrate a system without files or devices");
    demo->require_subcommand(1);
    for (const System& system : systems()) system.add_demo(*demo, exit_code);
}

}  // namespace tact::launch
