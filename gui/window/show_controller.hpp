// Fills the panels from the controller: newest records, events, and the result of the last command.
//
// Thread   frame thread.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"

namespace tact {

void show_controller(Controller& controller, const CommandSender& commands, DashboardState& state);
// Each kind of warning, and changes of the level, have one row, which counts: what comes again and again does not push out
// the rest.
void add_event(EventLine line, std::deque<EventLine>& events);
// Adds a sample to the plots.
void add_health(const HealthTopic& health, History& to);
// Updates rates over records: lateness, samples per second. Another controller restarts them.
void add_rates(const Controller& controller, const Controller::Fresh& fresh, DashboardState& to);
// Adds every servo cycle since the last frame.
void add_cycles(const Controller& controller, RingCursor& place, DashboardState& to);
void forget_rates(DashboardState& state);
void forget_run(DashboardState& state);  // with its events and plots
void add_load(const LoadTopic& load, const LevelsTopic* levels, History& to);

}  // namespace tact
