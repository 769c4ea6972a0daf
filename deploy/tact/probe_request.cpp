#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <span>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/probe.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {

namespace {

std::string text_at(const nlohmann::json& object, const char* key) {
    const auto at = object.find(key);
    return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

}  // namespace

DeviceRequest device_request_from(const nlohmann::json& answer) {
    DeviceRequest request;
    const nlohmann::json values = answer.value("values", nlohmann::json::object());
    for (const auto& [key, target] :
         {std::pair{"device.driver", &request.driver}, std::pair{"device.serial", &request.serial},
          std::pair{"device.firmware", &request.firmware},
          std::pair{"device.hd_library", &request.hd_library},
          std::pair{"device.fd_library", &request.fd_library}, std::pair{"device2.driver", &request.driver2},
          std::pair{"device2.serial", &request.serial2}, std::pair{"tracker.driver", &request.tracker},
          std::pair{"tracker.interface", &request.tracker_interface},
          std::pair{"tracker.host", &request.tracker_host},
          std::pair{"tracker.devices", &request.tracker_devices},
          std::pair{"tracker.format", &request.tracker_format}, std::pair{"lines.driver", &request.lines},
          std::pair{"lines.chip", &request.lines_chip}})
        if (const auto at = values.find(key); at != values.end() && at->is_string())
            *target = at->get<std::string>();
    if (const auto at = values.find("tracker.port"); at != values.end() && at->is_number_integer())
        request.tracker_port = at->get<int>();
    if (const auto at = values.find("tracker.rate_hz"); at != values.end() && at->is_number())
        request.tracker_rate_hz = at->get<double>();
    for (const nlohmann::json& p : answer.value("problems", nlohmann::json::array())) {
        const std::string key = text_at(p, "key");
        request.problems.push_back(
            {"configuration", FindingLevel::fail,
             text_at(p, "where") + (key.empty() ? "" : ": " + key) + ": " + text_at(p, "problem"),
             text_at(p, "fix")});
    }
    std::error_code error;
    if (const auto bytes = std::filesystem::file_size(request.firmware, error);
        !error && access(request.firmware.c_str(), R_OK) == 0)
        request.firmware_bytes = static_cast<std::int64_t>(bytes);
    return request;
}

DeviceRequest read_device_request(const std::string& path) {
    const ScratchFolder scratch;
    const auto file = scratch.path() / "check.json";
    ChildSettings settings;
    settings.arguments = {"--check-config=" + path, "--json"};
    settings.output_fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    Child child("tact-rt", find_program("tact-rt"), settings);
    if (settings.output_fd >= 0) ::close(settings.output_fd);
    const auto& ending = child.wait(std::chrono::seconds(30));
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto answer = nlohmann::json::parse(text, nullptr, false);
    if (!ending || ending->by_signal || !answer.is_object())
        throw StartupError(
            "checking the configuration " + path,
            "tact-rt " + (ending ? ending->text() : "did not end within 30 s") + ": " + text.substr(0, 1000),
            "run tact config check " + path);
    DeviceRequest request = device_request_from(answer);
    const nlohmann::json problems = answer.value("problems", nlohmann::json::array());
    if (!problems.empty() && text_at(problems.front(), "key").empty())
        throw StartupError(text_at(problems.front(), "where"), text_at(problems.front(), "problem"),
                           text_at(problems.front(), "fix"));
    return request;
}

namespace {

// "" if the file configured, or every place, is missing.
std::string find_library(const std::filesystem::path& root, const std::string& configured,
                         std::span<const char* const> places) {
    std::error_code error;
    if (!configured.empty()) return std::filesystem::exists(configured, error) ? configured : "";
    for (std::string place : places) {
        if (!place.starts_with("/")) continue;  // the loader searches names without a path
        if (std::filesystem::exists(root / place.substr(1), error)) return place;
    }
    return "";
}

}  // namespace

VendorLibraries find_libraries(const std::filesystem::path& root, const DeviceRequest& request) {
    constexpr std::array kInverseService{"/etc/haply-inverse-service"};
    return {.hd = find_library(root, request.hd_library, probe::kHdPlaces),
            .fd = find_library(root, request.fd_library, probe::kFdPlaces),
            .inverse_service = find_library(root, "", kInverseService)};
}

}  // namespace tact::launch
