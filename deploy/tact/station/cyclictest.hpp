// Runs cyclictest (package rt-tests) for comparison: the latency of the kernel alone, measured by an independent
// program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"

namespace tact::launch {

struct CyclictestPlace {
    int core = -1;        // -1: not pinned
    bool beside = false;  // runs during the controller's run; false: after it
    std::string text;     // description for the report
};

// Another isolated core, during the controller's run, if there is one; else the servo's core, after the run.
[[nodiscard]] CyclictestPlace place_cyclictest(int servo_core, const std::vector<int>& isolated,
                                               const std::vector<int>& siblings_of_servo);

// Largest latency in the JSON output, in microseconds; empty if the text is invalid or has no cycles.
[[nodiscard]] std::optional<double> parse_cyclictest(const std::string& text);

[[nodiscard]] std::vector<std::string> cyclictest_arguments(int core, double seconds,
                                                            const std::string& json);

}  // namespace tact::launch
