// Log format for journald on standard error: level prefix, no time stamp.
#pragma once

#include <spdlog/formatter.h>

#include <memory>

namespace tact {

// True if the file is the stream named by JOURNAL_STREAM, not a later redirection.
[[nodiscard]] bool is_journal_stream(int fd);

// "<4>text" with syslog levels. Each line of a message has a prefix, because journald makes one entry per line.
[[nodiscard]] std::unique_ptr<spdlog::formatter> make_journal_formatter();

}  // namespace tact
