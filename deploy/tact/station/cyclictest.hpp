// cyclictest (package rt-tests) beside the controller: what the kernel alone does, by an independent program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/child.hpp"

namespace tact::launch {

struct CyclictestPlace {
    int core = -1;        // -1: not pinned
    bool beside = false;  // while the controller runs; else after it
    std::string text;     // for people
};

// On another isolated core beside the controller where there is one, else on the servo's after it.
[[nodiscard]] CyclictestPlace place_cyclictest(int servo_core, const std::vector<int>& isolated,
                                               const std::vector<int>& siblings_of_servo);

// Largest latency in its JSON output, in microseconds; nothing: it is none, or it made no cycle.
[[nodiscard]] std::optional<double> parse_cyclictest(const std::string& text);

[[nodiscard]] std::vector<std::string> cyclictest_arguments(int core, double seconds,
                                                            const std::string& json);

}  // namespace tact::launch
