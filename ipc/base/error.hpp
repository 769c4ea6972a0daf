// The one exception of start-up, preparation and the launcher. Never thrown on the servo path.
//
// Text    what was attempted and on what, why it failed, and what mends it; in that order.
// Caught  once, in main(), which prints what() and exits with 1.
#pragma once

#include <stdexcept>
#include <string>

namespace tact {

class StartupError : public std::runtime_error {
public:
    StartupError(const std::string& attempt, const std::string& why, const std::string& mend)
        : std::runtime_error(attempt + ": " + why + "\n  mend: " + mend) {}
};

}  // namespace tact
