// tact without a command: a window with demos and recent scenes, and the run of what a person chooses there. A run that fails leads back to the page,
// which shows why.
//
// Input    requests of the window (ipc/scene/file/scene_switch): bounded and checked before the page closes
// Thread   the launcher's only thread
#pragma once

#include <string>
#include <vector>

namespace tact::launch {

// words: options of the page that every run takes too. Returns the exit code: of the run, or of the page if nothing was chosen. Throws
// StartupError without a display.
int run_start_page(const std::vector<std::string>& words);

}  // namespace tact::launch
