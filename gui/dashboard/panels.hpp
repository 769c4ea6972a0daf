// Panels common to all systems; gui/window/layout.cpp places them.
#pragma once

#include "gui/dashboard/dashboard_state.hpp"
#include "gui/dashboard/pixel_rect.hpp"

namespace tact {

void draw_health(const Theme& theme, DashboardState& state, const PixelRect& card);
// The same in two lines, for a window without room for cards.
void draw_health_strip(const Theme& theme, DashboardState& state, const PixelRect& card);
// Arm, disarm, reset: as wide as the window, enabled where the state of the run allows them.
void draw_run_buttons(DashboardState& state);
// "ACTIVE"
[[nodiscard]] std::string run_badge_text(RunState state);
// Inside the controller card: devices, tracker, motors.
void draw_device_rows(const Theme& theme, const DashboardState& state);
// Histogram of cycle lateness in a box of this size.
void draw_lateness(const Theme& theme, const DashboardState& state, ImVec2 size, bool whole_run);
void draw_plots(const Theme& theme, DashboardState& state, const PixelRect& card);
// In place of the plots: every servo cycle.
void draw_traces(const Theme& theme, DashboardState& state);
void draw_trace_lanes(const Theme& theme, DashboardState& state, ImVec2 size);
void draw_events(const Theme& theme, DashboardState& state, const PixelRect& card);
// Frame times as one line; empty while unknown.
[[nodiscard]] std::string frame_line(const FrameMetrics& metrics);
// Frame times as a table over the 3D view.
void draw_frame_times(const Theme& theme, const FrameMetrics& metrics, const PixelRect& view);

}  // namespace tact
