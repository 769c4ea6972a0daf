// Figure 1 of the drilling paper: six screenshots of a run of the scripted surgeon and the suction tube in the
// synthetic temporal bone.
//
// Writes   fig1_drilling-01.png to -06.png: the view alone, at equal intervals, the first before the burr enters the
//          bone; fig1_drilling.png: the whole window at the end; fig1_run.json
// Fails by StartupError if programs are missing
#pragma once

#include <filesystem>

namespace tact::launch {

int drilling_pictures(const std::filesystem::path& out, bool quick);  // returns the exit code of the run

}  // namespace tact::launch
