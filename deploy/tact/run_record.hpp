// What a run looked like over time: ten samples a second for the CSV, one line a second for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/observer.hpp"

namespace tact::launch {

// A value of one system: a column of the CSV.
struct OwnValue {
    const char* column;
    double value;
    int decimals;
};

struct Sample {
    double t_s = 0.0;  // since the launcher first saw the controller
    HealthTopic health{};
    double level_picture = 0.0, level_force = 0.0, level_particles = 0.0;  // 0: not governed
    std::uint32_t points = 0;                                              // felt
    std::uint32_t vertices_asked = 0;
    // Filled in by the system that runs (system_run.hpp):
    std::vector<OwnValue> own;
    std::string heading;     // of the table's last columns
    std::string line_end;    // and of the line
    bool particles = false;  // the display draws particles and rays in place of a mesh
};

class SystemRun;

// Empty while the controller has not published its health. system: null where the scene is not known.
std::optional<Sample> take_sample(const RtRegion& region, const SystemRun* system, double t_s);

// The columns besides the rates depend on the system.
std::string table_header(const Sample& sample);
std::string table_row(const Sample& sample);
std::string samples_csv(const std::vector<Sample>& samples);

}  // namespace tact::launch
