// True: an error's text contains all of these.
#pragma once

#include <initializer_list>
#include <string>

namespace tact {

inline bool says(const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* part : parts) {
        if (text.find(part) == std::string::npos) return false;
    }
    return true;
}

}  // namespace tact
