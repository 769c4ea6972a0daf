// A log sink that never blocks. If nobody reads standard error, it drops and counts lines, and logs the count as soon as
// there is room again: with the next line, or in flush().
//
// Takes    a pipe, a terminal, a socket or a file. A pipe or terminal is reopened as non-blocking for this process alone,
//          so that the mode of other users' descriptors does not change.
// Thread   any; lines are serialized, and none blocks
#pragma once

#include <spdlog/sinks/sink.h>

#include <memory>

namespace tact {

// The caller owns fd and keeps it open as long as the sink exists.
[[nodiscard]] std::shared_ptr<spdlog::sinks::sink> make_log_sink(int fd);

}  // namespace tact
