// The scenes on which the governor is judged (bench_governor.hpp).
//
// Scenes   docking: structures of about 30 000, 160 000 and 500 000 atoms, shifted copies of one structure (from the
//          demo or a file); surface: a 6-DoF tool of 1000 points on two million triangles; drilling: a burr with a
//          radius of 20 mm in voxels of 0.1 mm
// Work     a fraction of it, for a slow or emulated processor, whose loop then has as much of its period for each part:
//          fewer atoms and points, and voxels so much larger that the burr meets fewer
// Kept     scenes are baked into a folder; with a folder of one's own, those that are there already are used as they are
// Fails    StartupError
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact {

struct GovernorSceneSettings {
    std::vector<std::string> kinds{"docking", "surface", "drilling"};
    std::vector<std::size_t> atoms{30'000, 160'000, 500'000};
    std::filesystem::path map, structure;  // empty: those of the demo
    double work = 1.0;
    std::filesystem::path folder;  // empty: a temporary one
};

struct BenchScene {
    std::string name;
    std::size_t atoms = 0;
    std::filesystem::path path;
    std::string knob;
    std::vector<double> levels;          // fixed levels
    std::vector<std::string> arguments;  // for tact run
};

// A temporary folder, removed at the end.
struct BenchFolder {
    std::filesystem::path path;
    BenchFolder();
    ~BenchFolder();
    BenchFolder(const BenchFolder&) = delete;
    BenchFolder& operator=(const BenchFolder&) = delete;
};

// Output goes to the log.
void run_program(const std::string& name, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log, Duration most);

// Prints progress to standard error. scratch: for files that nobody needs later.
[[nodiscard]] std::vector<BenchScene> bake_governor_scenes(const GovernorSceneSettings& settings,
                                                           const std::filesystem::path& scratch);

}  // namespace tact
