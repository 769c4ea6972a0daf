#include "tests/emu/part_requests.hpp"

#include <charconv>
#include <vector>

#include "hal/arm/arm_parameters.hpp"
#include "ipc/base/error.hpp"
#include "tests/emu/script.hpp"

namespace tact::emu {

namespace {

constexpr const char* kTrackerForm = "write INTERFACE[:classic|fd[:RATE_HZ[:SENSORS]]], as in vcan0:fd:240:4";

std::vector<std::string> fields_of(const std::string& text) {
    std::vector<std::string> fields{""};
    for (const char c : text) {
        if (c == ':') {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

unsigned number_of(const std::string& text, const std::string& word, unsigned low, unsigned high) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value < low || value > high)
        throw StartupError(
            "--tracker " + text,
            "\"" + word + "\" is not a number from " + std::to_string(low) + " to " + std::to_string(high),
            kTrackerForm);
    return value;
}

}  // namespace

ArmRequest parse_arm(const std::string& text) {
    const std::vector<std::string> fields = fields_of(text);
    if (fields.size() > 2 || !is_serial(fields[0]))
        throw StartupError("--arm " + text, "a serial is 1 to 16 letters, digits, '-' and '_'",
                           "write SERIAL[:MODEL], as in LEFT:premium-1.5");
    ArmRequest request{fields[0], arm_parameter_set(fields.size() > 1 ? fields[1] : "premium-1.5")};
    static_cast<void>(arm_parameters(request.metrics));  // refuses a model with unknown parameters
    return request;
}

TrackerRequest parse_tracker(const std::string& text) {
    const std::vector<std::string> fields = fields_of(text);
    TrackerRequest request;
    request.interface = fields[0];
    request.can.fix.format = CanFormat::classic;
    request.can.fix.sensors = 1;
    if (fields.size() > 4 || request.interface.empty() || request.interface.size() > 15)
        throw StartupError("--tracker " + text, "the interface is missing", kTrackerForm);
    if (fields.size() > 1) {
        if (fields[1] != "classic" && fields[1] != "fd")
            throw StartupError("--tracker " + text, "the format \"" + fields[1] + "\" is unknown",
                               kTrackerForm);
        if (fields[1] == "fd") request.can.fix.format = CanFormat::fd;
    }
    if (fields.size() > 2) request.can.rate_hz = number_of(text, fields[2], 10, 2000);
    if (fields.size() > 3) request.can.fix.sensors = number_of(text, fields[3], 1, kTrackerSensorsMax);
    return request;
}

}  // namespace tact::emu
