// Log lines as journald reads them from standard error: the level in front, no time of our own.
#pragma once

#include <spdlog/formatter.h>

#include <memory>

namespace tact {

// Whether that file is the stream that JOURNAL_STREAM names, and not one that it was redirected to since.
[[nodiscard]] bool is_journal_stream(int fd);

// "<4>text": syslog levels. Each line of a message has its own, because journald makes an entry of each.
[[nodiscard]] std::unique_ptr<spdlog::formatter> make_journal_formatter();

}  // namespace tact
