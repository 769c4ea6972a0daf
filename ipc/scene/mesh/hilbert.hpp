// Index of a cell on Hilbert's curve through a cube of 2^kBits cells per side: consecutive cells are
// adjacent in space (J. Skilling, "Programming the Hilbert curve", 2004).
#pragma once

#include <array>
#include <cstdint>

namespace tact {

template <std::uint32_t kBits>
constexpr std::uint64_t hilbert(std::array<std::uint32_t, 3> cell) {
    static_assert(kBits > 0 && 3 * kBits <= 64);
    constexpr std::uint32_t kTop = 1U << (kBits - 1);
    for (std::uint32_t q = kTop; q > 1; q >>= 1U) {
        const std::uint32_t p = q - 1;
        for (std::size_t i = 0; i < 3; ++i) {
            if ((cell[i] & q) != 0) {
                cell[0] ^= p;
            } else {
                const std::uint32_t t = (cell[0] ^ cell[i]) & p;
                cell[0] ^= t;
                cell[i] ^= t;
            }
        }
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    std::uint32_t t = 0;
    for (std::uint32_t q = kTop; q > 1; q >>= 1U) {
        if ((cell[2] & q) != 0) t ^= q - 1;
    }
    std::uint64_t key = 0;
    for (std::uint32_t bit = kBits; bit-- > 0;) {
        for (const std::uint32_t value : cell) key = key << 1U | ((value ^ t) >> bit & 1U);
    }
    return key;
}

}  // namespace tact
