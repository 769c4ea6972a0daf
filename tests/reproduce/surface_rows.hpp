// Results for one mesh, tool, hand and mode: rate, times and progress of the proxy.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/touch_run.hpp"

namespace tact::launch {

struct TouchRow {
    std::string mesh, tool, mode, hand;
    std::size_t triangles = 0, steps = 0;
    double rate_hz = 0.0;  // reciprocal of the mean time of a step
    double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
    double over_1ms = 0.0;  // fraction of the steps
    double touching = 0.0;  // fraction of the steps with a force
    double unsettled = 0.0;
    std::uint64_t jammed = 0;
    double adaptive = 0.0;  // fraction of the steps on the adaptive surface
    // Difference from the force of another mode in the same steps: mean and maximum, relative to the mean force in
    // contact, and 99th percentile of the angle in the steps in contact. Negative: not compared.
    double error_mean = -1.0, error_max = -1.0, angle_p99_deg = -1.0;
};

TouchRow row_of(const std::vector<TouchStep>& steps);
// reference: has at least as many steps.
void compare(TouchRow& row, const std::vector<TouchStep>& steps, const std::vector<TouchStep>& reference);

// See surface.hpp, Quality.
[[nodiscard]] std::string quality(const TouchRow& row);

[[nodiscard]] std::string csv_of(const std::vector<TouchRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<TouchRow>& rows);

}  // namespace tact::launch
