// Compares the detected devices with those of the configuration.
//
// judge_devices() is pure, so that tests can use recorded trees of files and texts of other machines. Levels as in the
// doctor: a configured device that is missing or not usable fails; other devices are listed, or warned about.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "deploy/tact/doctor.hpp"
#include "deploy/tact/rights.hpp"
#include "hal/probe/buses.hpp"
#include "hal/probe/igtl_answer.hpp"
#include "ipc/spacenav/spacenav_socket.hpp"

namespace tact::launch {

// The device settings of tact-rt's configuration; the defaults are those of tact-rt.
struct DeviceRequest {
    std::string driver = "sim", serial, hd_library, fd_library, firmware;
    std::string driver2 = "none", serial2;  // second hand
    std::int64_t firmware_bytes = -1;       // size of that file on this machine; -1: not readable
    std::string tracker = "none", tracker_interface = "can0", tracker_format = "classic";
    std::string tracker_host = "127.0.0.1", tracker_devices;  // of driver "openigtlink"
    int tracker_port = 18944;
    double tracker_rate_hz = 240.0;
    std::string lines = "none", lines_chip = "cp2112_gpio";
    std::vector<Finding> problems;  // problems of the file as a whole
};

// Reads the settings through tact-rt, which has the only reader. Throws StartupError if the file cannot be read at all.
[[nodiscard]] DeviceRequest read_device_request(const std::string& path);
// Parses the output of tact-rt --check-config FILE --json. Also reads the size of the firmware file.
[[nodiscard]] DeviceRequest device_request_from(const nlohmann::json& answer);

// Manufacturers' libraries and services: of each the first path that exists, else "".
struct VendorLibraries {
    std::string hd, fd;           // of the drivers openhaptics and forcedimension
    std::string inverse_service;  // of the driver inverse3: configuration folder of its service
};
[[nodiscard]] VendorLibraries find_libraries(const std::filesystem::path& root, const DeviceRequest& request);

// What the OpenIGTLink server of the request sends; only for tracker.driver = "openigtlink".
[[nodiscard]] Finding judge_igtl(const probe::IgtlAnswer& answer, const DeviceRequest& request);

// SpaceMouse and gamepads, which lead an emulated hand or move the view; none is needed.
[[nodiscard]] std::vector<Finding> judge_input(const SpacenavFound& spacenav,
                                               const probe::Bus<probe::Joystick>& sticks);

[[nodiscard]] std::vector<Finding> judge_devices(const probe::Buses& buses, const DeviceRequest& request,
                                                 const Person& person, const VendorLibraries& libraries);

}  // namespace tact::launch
