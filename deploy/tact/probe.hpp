// Which devices there are, whether they are the ones that the configuration asks for, and what is wrong.
//
// judge_devices() is pure, so that trees of files and texts of other machines test it. Levels as the
// doctor's: what the configuration asks for and is not there, or may not be used, fails; what nobody asked for
// is told, or warned about.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "deploy/tact/doctor.hpp"
#include "deploy/tact/rights.hpp"
#include "hal/probe/buses.hpp"

namespace tact::launch {

// Of the configuration of tact-rt, what it says about devices; the defaults are tact-rt's.
struct DeviceRequest {
    std::string driver = "sim", serial, hd_library, firmware;
    std::string driver2 = "none", serial2;  // of the second hand
    std::int64_t firmware_bytes = -1;       // of that file, as the machine has it; -1: it cannot be read
    std::string tracker = "none", tracker_interface = "can0", tracker_format = "classic";
    std::string lines = "none", lines_chip = "cp2112_gpio";
    std::vector<Finding> problems;  // of the file as a whole
};

// Asks tact-rt, whose reader is the only one. Throws StartupError where the file cannot be read at all.
[[nodiscard]] DeviceRequest read_device_request(const std::string& path);
// From the answer of tact-rt --check-config FILE --json. The size of the firmware file is read too.
[[nodiscard]] DeviceRequest device_request_from(const nlohmann::json& answer);

// The library of driver openhaptics: its path where one of the files is there, else "".
[[nodiscard]] std::string find_hd_library(const std::filesystem::path& root, const std::string& configured);

[[nodiscard]] std::vector<Finding> judge_devices(const probe::Buses& buses, const DeviceRequest& request,
                                                 const Person& person, const std::string& hd_library);

}  // namespace tact::launch
