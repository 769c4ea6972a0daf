// Formats like printf, into a string.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace tact {

[[gnu::format(printf, 1, 2)]] inline std::string printed(const char* format, ...) {
    std::string text(200, '\0');
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    const int size = std::vsnprintf(text.data(), text.size() + 1, format, values);
    va_end(values);
    const auto needed = static_cast<std::size_t>(size > 0 ? size : 0);
    text.resize(needed);
    if (needed > 200) std::vsnprintf(text.data(), needed + 1, format, again);
    va_end(again);
    return text;
}

}  // namespace tact
