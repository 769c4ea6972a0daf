// How this controller was started, for recordings: its arguments and the files that they name.
#pragma once

#include <span>

#include "ipc/topics/record.hpp"
#include "rt/start/start_options.hpp"

namespace tact {

// Start-up. What does not fit, or cannot be read any more, is marked as too long.
void tell_how_started(std::span<char* const> arguments, const StartOptions& options, RunText& text);

}  // namespace tact
