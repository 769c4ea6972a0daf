// Draws the figures of a reproduction: a Python script reads the CSV and JSON files.
#pragma once

#include <filesystem>

namespace tact::launch {

// Runs PREFIX/share/tact/reproduce/draw.py on `folder`; PREFIX/bin is the folder of the running program (also in a
// build folder). Without Python, matplotlib or the script, prints how to draw the figures by hand.
void draw_figures(const std::filesystem::path& folder);

}  // namespace tact::launch
