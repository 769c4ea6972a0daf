// Finds the GPIO chip that the configuration names, with error messages for a missing one.
//
// Errors   StartupError with chip, line and fix
// Thread   start-up, and a pump that searches for its adapter again
#pragma once

#include <string>
#include <vector>

#include "hal/io/gpio_access.hpp"

namespace tact {

// The one chip with this label ("cp2112_gpio"), name ("gpiochip0") or path. Numbers change when an adapter
// is plugged in again, labels do not.
[[nodiscard]] GpioChip find_gpio_chip(const std::string& wanted, const std::string& folder = "/dev");

// Throws the error of a line request on this chip as a text for people.
[[noreturn]] void throw_gpio_refusal(const GpioChip& chip, const GpioRefusal& refusal);

}  // namespace tact
