// Data for deploy/manual/completion.bash, as assignments to its arrays.
#pragma once

#include <string>

#include "ipc/manual/command.hpp"

namespace tact::manual {

std::string completion(const Command& program);

}  // namespace tact::manual
