// What the panels show of the controller: its newest records, events and the fate of the last command.
//
// Thread   frame thread.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"

namespace tact {

void show_controller(Controller& controller, const CommandSender& commands, DashboardState& state);
// One more sample of the plots.
void add_health(const HealthTopic& health, History& to);
// What is counted up over records: lateness, samples a second. Another controller begins anew.
void add_rates(const Controller& controller, const Controller::Fresh& fresh, DashboardState& to);
// Every servo cycle since the frame before.
void add_cycles(const Controller& controller, RingCursor& place, DashboardState& to);
void forget_rates(DashboardState& state);
void add_load(const LoadTopic& load, const LevelsTopic* levels, History& to);

}  // namespace tact
