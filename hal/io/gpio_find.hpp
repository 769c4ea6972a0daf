// Which GPIO chip a person means, and what to say where there is none.
//
// Fails by StartupError naming chip, line and fix
// Thread   start-up, and a pump that looks for its adapter again
#pragma once

#include <string>
#include <vector>

#include "hal/io/gpio_access.hpp"

namespace tact {

// The one chip of this label ("cp2112_gpio"), name ("gpiochip0") or path. Numbers change when an adapter is
// plugged in anew, labels do not.
[[nodiscard]] GpioChip find_gpio_chip(const std::string& wanted, const std::string& folder = "/dev");

// What befell a request of lines of this chip, for people.
[[noreturn]] void throw_gpio_refusal(const GpioChip& chip, const GpioRefusal& refusal);

}  // namespace tact
