// For targets of file readers: the first byte selects the format, the rest is the file.
//
// Refusals  of a reader are StartupErrors with a fix; any other exception is a finding
#pragma once

#include <cstring>
#include <string_view>

#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

inline Input seed(unsigned format, std::string_view text) {
    Input s;
    s.reserve(1 + text.size());
    s.push_back(static_cast<std::byte>(format));
    const auto bytes = std::as_bytes(std::span(text));
    s.insert(s.end(), bytes.begin(), bytes.end());
    return s;
}

// Calls use(format, text) with format below `formats`.
template <class Use>
bool run_formats(std::span<const std::byte> input, unsigned formats, const Use& use) {
    if (input.empty()) return false;
    const std::string_view text(reinterpret_cast<const char*>(input.data() + 1), input.size() - 1);
    try {
        use(static_cast<unsigned>(input[0]) % formats, text);
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
        return false;
    }
    return true;
}

}  // namespace tact::fuzz
