// Table of the safety line drivers. The names are the values of lines.driver in the configuration.
//
// Errors   make_lines: StartupError, listing the known drivers
// Thread   start-up
#pragma once

#include <memory>
#include <span>
#include <string>

#include "hal/io/gpio_port.hpp"

namespace tact {

struct LinesSettings {
    std::string driver = "none";
    GpioPortSettings gpio;
    LineLogicSettings logic;  // the driver sets the fitted lines
    Duration every = std::chrono::milliseconds(1);
};

struct LinesEntry {
    const char* name;
    const char* what;  // description for people
    std::unique_ptr<Lines> (*make)(const LinesSettings&);
};

[[nodiscard]] std::span<const LinesEntry> lines_drivers();
[[nodiscard]] std::unique_ptr<Lines> make_lines(const LinesSettings& settings);  // null: "none"

}  // namespace tact
