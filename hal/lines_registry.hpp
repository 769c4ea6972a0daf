// The one table of safety lines. Names are those of lines.driver in the configuration.
//
// Errors   make_lines: StartupError, naming what there is
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
    LineLogicSettings logic;  // what is fitted the driver knows
    Duration every = std::chrono::milliseconds(1);
};

struct LinesEntry {
    const char* name;
    const char* what;  // for people
    std::unique_ptr<Lines> (*make)(const LinesSettings&);
};

[[nodiscard]] std::span<const LinesEntry> lines_drivers();
[[nodiscard]] std::unique_ptr<Lines> make_lines(const LinesSettings& settings);  // null: "none"

}  // namespace tact
