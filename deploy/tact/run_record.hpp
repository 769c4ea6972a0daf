// The course of a run: ten samples per second for the CSV file, one line per second for people.
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
    double t_s = 0.0;  // since tact first saw the controller
    HealthTopic health{};
    double level_picture = 0.0, level_force = 0.0, level_particles = 0.0;  // 0: not governed
    std::uint32_t points = 0;                                              // points of the force model
    std::uint32_t vertices_asked = 0;
    // Set by the system that runs (system_run.hpp):
    std::vector<OwnValue> own;
    std::string heading;     // titles of the last columns of the table
    std::string line_end;    // values of the last columns
    bool particles = false;  // the display draws particles and rays instead of a mesh
};

class SystemRun;

// Empty until the controller has published its health. system: null if the scene is unknown.
std::optional<Sample> take_sample(const RtRegion& region, const SystemRun* system, double t_s);

// The columns after the rates depend on the system.
std::string table_header(const Sample& sample);
std::string table_row(const Sample& sample);
std::string samples_csv(const std::vector<Sample>& samples);

}  // namespace tact::launch
