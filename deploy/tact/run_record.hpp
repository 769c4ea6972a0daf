// What a run looked like over time: ten samples a second for the CSV, one line a second for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/observer.hpp"
#include "deploy/tact/place.hpp"

namespace tact::launch {

struct Sample {
    double t_s = 0.0;  // since the launcher first saw the controller
    HealthTopic health{};
    double level_picture = 0.0, level_force = 0.0, level_particles = 0.0;  // 0: not governed
    std::uint32_t points = 0;                                              // felt
    std::uint32_t vertices_asked = 0;
    std::optional<Offset> offset;    // of the active body
    std::optional<double> taken_m3;  // of bone; none: the scene has none
};

// Empty while the controller has not published its health.
std::optional<Sample> take_sample(const RtRegion& region, const Places* places, double t_s);

// What it names besides the rates depends on what the scene is.
std::string table_header(const Sample& sample);
std::string table_row(const Sample& sample);
std::string samples_csv(const std::vector<Sample>& samples);

}  // namespace tact::launch
