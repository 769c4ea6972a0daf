#include <algorithm>
#include <cmath>
#include <optional>

#include "deploy/tact/probe.hpp"
#include "ipc/base/printed.hpp"

namespace tact::launch {
namespace {

// The names in a list with commas, as the controller reads tracker.devices.
std::vector<std::string> names_in(const std::string& list) {
    std::vector<std::string> names(1);
    for (const char c : list) {
        if (c == ',')
            names.emplace_back();
        else if (c != ' ' || !names.back().empty())
            names.back() += c;
    }
    for (std::string& name : names) name.erase(name.find_last_not_of(' ') + 1);
    std::erase(names, "");
    return names;
}

std::string sent_text(const probe::IgtlAnswer& answer) {
    std::string text;
    for (const probe::IgtlSent& s : answer.sent) {
        text += (text.empty() ? "" : ", ") + s.type + " \"" + s.name + "\"";
        if (answer.listened_s > 0.0)
            text += printed(" (%.0f Hz", static_cast<double>(s.count) / answer.listened_s) +
                    (s.valid == 0 && (s.type == "TRANSFORM" || s.type == "TDATA") ? ", no valid pose)" : ")");
    }
    return text.empty() ? "nothing" : text + (answer.more ? ", and more" : "");
}

// What is wrong with one sensor of the configuration; empty: nothing.
std::optional<Finding> judge_sensor(const std::string& name, const probe::IgtlAnswer& answer,
                                    const DeviceRequest& request, const std::string& what,
                                    const std::string& sends) {
    const auto at = std::find_if(answer.sent.begin(), answer.sent.end(), [&](const probe::IgtlSent& s) {
        return s.name == name && (s.type == "TRANSFORM" || s.type == "TDATA");
    });
    if (at == answer.sent.end())
        return Finding{"tracker", FindingLevel::fail, what + "no pose \"" + name + "\"; " + sends,
                       "set tracker.devices to names that the server sends"};
    if (at->valid == 0)
        return Finding{"tracker", FindingLevel::warn, what + "no valid pose of \"" + name + "\"; " + sends,
                       "bring the sensor into the field of the tracker"};
    const double rate_hz = static_cast<double>(at->count) / std::max(answer.listened_s, 1e-3);
    if (rate_hz >= 0.7 * request.tracker_rate_hz && rate_hz <= 1.4 * request.tracker_rate_hz)
        return std::nullopt;
    return Finding{"tracker", FindingLevel::warn,
                   what + "\"" + name + "\" arrives at " +
                       printed("%.0f Hz, but tracker.rate_hz is %.0f; ", rate_hz, request.tracker_rate_hz) +
                       sends,
                   "set tracker.rate_hz to the rate of the server: late and lost poses are judged by it"};
}

}  // namespace

Finding judge_igtl(const probe::IgtlAnswer& answer, const DeviceRequest& request) {
    const std::string what =
        "OpenIGTLink server at " + request.tracker_host + ":" + std::to_string(request.tracker_port) + ": ";
    if (!answer.problem.empty())
        return {"tracker", FindingLevel::fail, what + answer.problem,
                "start the server (PLUS, 3D Slicer), or set tracker.host and tracker.port"};
    const std::string sends = "it sends " + sent_text(answer);
    const std::vector<std::string> names = names_in(request.tracker_devices);
    for (const std::string& name : names)
        if (auto wrong = judge_sensor(name, answer, request, what, sends)) return *wrong;
    if (names.empty())
        return {"tracker", FindingLevel::fail, what + "tracker.devices names no sensor; " + sends,
                "set tracker.devices to the name of the sensor on the glasses"};
    return {"tracker", FindingLevel::ok, what + sends, ""};
}

}  // namespace tact::launch
