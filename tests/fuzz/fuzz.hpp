// Interface of a fuzz target: its function on arbitrary bytes, and a few valid inputs as seeds.
//
// run() must return for any bytes: no crash, no sanitizer report, no endless loop, no exception.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace tact::fuzz {

using Input = std::vector<std::byte>;

bool run(std::span<const std::byte> input);  // true: the input was accepted
[[nodiscard]] std::vector<Input> seeds();    // made in code, all accepted; replay checks this

// A target with its own require(bool) calls this one.
template <std::same_as<bool> Claim>
void require(Claim claim) {
    if (!claim) std::abort();
}

// Makes a seed from a plain struct or a string.
template <class T>
Input bytes_of(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    return {bytes.begin(), bytes.end()};
}

}  // namespace tact::fuzz
