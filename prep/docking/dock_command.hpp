// tact-prep dock MAP MODEL..., tact-prep demo dock and tact-prep contour SCENE: docking scenes, and their surfaces at
// other levels.
#pragma once

#include <CLI/CLI.hpp>

namespace tact {

void add_dock(CLI::App& app, CLI::App& demo);
void add_contour(CLI::App& app);
// tact-prep examine dock
void add_examine_dock(CLI::App& examine);

}  // namespace tact
