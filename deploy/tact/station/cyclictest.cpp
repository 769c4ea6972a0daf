#include "deploy/tact/station/cyclictest.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tact::launch {

CyclictestPlace place_cyclictest(int servo_core, const std::vector<int>& isolated,
                                 const std::vector<int>& siblings_of_servo) {
    for (const int core : isolated) {
        const bool sibling =
            std::find(siblings_of_servo.begin(), siblings_of_servo.end(), core) != siblings_of_servo.end();
        if (core != servo_core && !sibling)
            return {core, true, "on core " + std::to_string(core) + ", beside the controller"};
    }
    if (servo_core >= 0)
        return {
            servo_core, false,
            "on core " + std::to_string(servo_core) + ", after the controller: no other core is isolated"};
    return {-1, false, "on any core, after the controller: no core is isolated"};
}

std::optional<double> parse_cyclictest(const std::string& text) {
    try {
        std::optional<double> most;
        const nlohmann::json all = nlohmann::json::parse(text);
        for (const auto& thread : all.at("thread")) {
            const auto us = thread.at("max").get<double>();
            if (thread.at("cycles").get<std::int64_t>() <= 0 || !std::isfinite(us) || us < 0.0)
                return std::nullopt;
            most = std::max(most.value_or(0.0), us);
        }
        return most;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

std::vector<std::string> cyclictest_arguments(int core, double seconds, const std::string& json) {
    const auto whole = static_cast<long>(std::ceil(std::max(seconds, 1.0)));
    std::vector<std::string> arguments{"--mlockall",    "--quiet",
                                       "--priority=79", "--interval=1000",
                                       "--threads=1",   "--duration=" + std::to_string(whole),
                                       "--json=" + json};
    if (core >= 0) arguments.push_back("--affinity=" + std::to_string(core));
    return arguments;
}

}  // namespace tact::launch
