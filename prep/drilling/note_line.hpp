// Formats lines of a scene's note.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace tact {

// Like printf; cuts the text after 319 bytes.
[[gnu::format(printf, 1, 2)]] inline std::string note_line(const char* format, ...) {
    char text[320];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

}  // namespace tact
