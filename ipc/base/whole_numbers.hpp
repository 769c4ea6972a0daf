// Parses whole numbers from the command line.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace tact {

// "1280x720" with letters "x", "0:256,10:90" with ":,:": numbers separated by exactly these letters, without sign.
template <std::size_t N>
[[nodiscard]] std::optional<std::array<std::uint32_t, N>> numbers_between(
    std::string_view text, const char (&letters)[N]) noexcept {  // N includes the terminating zero
    std::array<std::uint32_t, N> number{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < N; ++i) {
        const auto [behind, error] = std::from_chars(at, end, number[i]);
        if (error != std::errc{}) return std::nullopt;
        at = behind;
        if (i + 1 == N) break;
        if (at == end || *at != letters[i]) return std::nullopt;
        ++at;
    }
    if (at != end) return std::nullopt;
    return number;
}

}  // namespace tact
