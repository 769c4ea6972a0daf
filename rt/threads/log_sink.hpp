// The log of tact-rt: it waits for nobody. Where nobody reads standard error, lines are dropped and counted, and the
// count is said as soon as there is room again: with the next line, or by flush().
//
// Takes    a pipe, a terminal, a socket or a file. What others have open with it does not change: a pipe or a terminal
//          is opened once more, for this process alone.
// Thread   any; a line waits for the one before it, which waits for nothing
#pragma once

#include <spdlog/sinks/sink.h>

#include <memory>

namespace tact {

// fd stays the caller's, and open while there is a sink.
[[nodiscard]] std::shared_ptr<spdlog::sinks::sink> make_log_sink(int fd);

}  // namespace tact
