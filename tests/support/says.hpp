// True if the text of an error contains all these parts.
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
