// The visual process: draws frames until it is closed, its time is over, or a signal arrives.
//
// A frame   adapt    read the controller's topics, approach the level of "gui.mesh"
//           upload   changes of the surface
//           scene    the 3D view
//           panels   the dashboard
//           swap     show; then publish the load, which is also the heartbeat
// Thread    frame thread; a loader thread reads scenes.
#pragma once

#include "gui/window/options.hpp"

namespace tact {

// Returns the exit code. Throws StartupError before the first frame.
int run_gui(const GuiOptions& options);

}  // namespace tact
