// Sections of the configuration that are more than a row a key.
#pragma once

#include <toml++/toml.h>
#include <string>

#include "hal/arm/arm_table.hpp"

namespace tact {

// [arm] of the file at path. StartupError with file, line, key and the mend.
void read_arm_section(const toml::table& section, const std::string& path, ArmFigures& arm);

// A number as the messages name it.
std::string number_text(double v);

}  // namespace tact
