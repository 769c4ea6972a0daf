// What a fuzz target gives: what it does with any bytes, and a few good inputs to start from.
//
// run() must come back whatever the bytes are: no crash, no sanitizer report, no endless work, no exception.
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
[[nodiscard]] std::vector<Input>
seeds();  // made in code, every one accepted; replay checks that they still are

// A target that has its own require(bool) calls that one.
template <std::same_as<bool> Claim>
void require(Claim claim) {
    if (!claim) std::abort();
}

// A seed from a plain struct or a string.
template <class T>
Input bytes_of(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    return {bytes.begin(), bytes.end()};
}

}  // namespace tact::fuzz
