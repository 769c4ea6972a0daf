// The figures of a reproduction: a Python script draws them from the CSV and JSON files.
#pragma once

#include <filesystem>

namespace tact::launch {

// Starts PREFIX/share/tact/reproduce/draw.py, PREFIX/bin being the folder of the running program (in a build folder too),
// on `folder`. Where Python, matplotlib or the script is missing, one line says how to get the figures.
void draw_figures(const std::filesystem::path& folder);

}  // namespace tact::launch
