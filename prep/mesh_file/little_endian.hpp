// Numbers of binary mesh files.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace tact {

inline void put_word(std::string& out, std::uint32_t word) {
    for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<char>(word >> (8 * i)));
}
inline void put_float(std::string& out, float x) {
    std::uint32_t word = 0;
    std::memcpy(&word, &x, sizeof word);
    put_word(out, word);
}

}  // namespace tact
