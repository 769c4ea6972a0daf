// The start parameters of this controller, for recordings: its arguments and the files that they name.
#pragma once

#include <span>

#include "ipc/topics/record.hpp"
#include "rt/start/start_options.hpp"

namespace tact {

// Start-up. Marks texts that do not fit, or files that cannot be read, as too long.
void tell_how_started(std::span<char* const> arguments, const StartOptions& options, RunText& text);

}  // namespace tact
