// The window of `tact` without arguments: a start page instead of a scene. It has no controller; what is chosen, the launcher runs.
//
// Thread   frame thread.
#pragma once

#include "gui/window/options.hpp"

namespace tact {

// Returns the exit code. Throws StartupError before the first frame.
int run_start_page(const GuiOptions& options);

}  // namespace tact
