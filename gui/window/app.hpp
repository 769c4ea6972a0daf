// The visual process: one frame after the other until it is closed, its time is over or a signal comes.
//
// A frame   adapt    read the controller's topics, go towards the level of "gui.mesh"
//           upload   what of the surface changed
//           scene    the 3D view
//           panels   the dashboard
//           swap     show; then the load is published, which is also the heartbeat
// Thread    frame thread; scenes are read by a loader thread of its own.
#pragma once

#include "gui/window/options.hpp"

namespace tact {

// Returns the exit code. Throws StartupError before the first frame.
int run_gui(const GuiOptions& options);

}  // namespace tact
