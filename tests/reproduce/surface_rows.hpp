// What one way of touching one mesh with one tool gave: rate, times, whether the proxy followed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/touch_run.hpp"

namespace tact::launch {

struct TouchRow {
    std::string mesh, tool, mode, hand;
    std::size_t triangles = 0, steps = 0;
    double rate_hz = 0.0;  // one over the mean time of a step
    double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
    double over_1ms = 0.0;  // share of the steps
    double touching = 0.0;  // share of the steps with a force
    double unsettled = 0.0;
    std::uint64_t jammed = 0;
    double adaptive = 0.0;  // share of the steps that felt the adaptive surface
    // Of the force, to the same steps of another way, in its own units: mean and largest difference by the mean force
    // in contact, the angle that 99 % of the steps in contact stay below. Negative: not compared.
    double error_mean = -1.0, error_max = -1.0, angle_p99_deg = -1.0;
};

TouchRow row_of(const std::vector<TouchStep>& steps);
// reference: at least as many steps.
void compare(TouchRow& row, const std::vector<TouchStep>& steps, const std::vector<TouchStep>& reference);

// See surface.hpp, Quality.
[[nodiscard]] std::string quality(const TouchRow& row);

[[nodiscard]] std::string csv_of(const std::vector<TouchRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<TouchRow>& rows);

}  // namespace tact::launch
