// The only exception type of start-up, preparation and the launcher. Never thrown on the servo path.
//
// Text    the attempt and its object, the reason of the failure, and the fix; in that order. Text from
//         untrusted files may be part of it: control characters except newlines become '?', so that none
//         truncates the text or controls a terminal.
// Caught  once, in main(), which prints what() and exits with 1.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace tact {

// Text of errno.
inline std::string last_error() { return std::system_category().message(errno); }

class StartupError : public std::runtime_error {
public:
    StartupError(const std::string& attempt, const std::string& why, const std::string& fix)
        : std::runtime_error(shown(attempt + ": " + why + "\n  fix: " + fix)) {}

private:
    static std::string shown(std::string text) {
        for (char& c : text) {
            const auto code = static_cast<unsigned char>(c);
            if ((code < 0x20 && c != '\n') || code == 0x7F) c = '?';
        }
        return text;
    }
};

}  // namespace tact
