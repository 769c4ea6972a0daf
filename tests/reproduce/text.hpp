// Text formatting for reports.
#pragma once

#include <cstdio>
#include <string>

namespace tact::launch {

// Formats like printf; truncates to 511 bytes.
template <class... A>
std::string text(const char* format, A... a) {
    char line[512];
    std::snprintf(line, sizeof line, format, a...);
    return line;
}

}  // namespace tact::launch
