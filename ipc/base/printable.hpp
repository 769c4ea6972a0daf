// Text from outside, such as a file's name, for one line of output or of a note: control characters become '?'.
#pragma once

#include <string>

namespace tact {

[[nodiscard]] inline std::string printable(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text;
}

}  // namespace tact
