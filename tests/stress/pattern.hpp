// A record in which every word follows from its number, so that a mixture of two is detected.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tact::stress {

template <std::size_t Words>
struct alignas(8) Pattern {
    std::uint64_t word[Words];

    [[nodiscard]] std::uint64_t number() const { return word[0]; }
    [[nodiscard]] bool whole() const {
        for (std::size_t i = 1; i < Words; ++i) {
            if (word[i] != word[0] * (2 * i + 1)) return false;
        }
        return true;
    }
};

template <std::size_t Words>
Pattern<Words> pattern(std::uint64_t number) {
    Pattern<Words> p;
    p.word[0] = number;
    for (std::size_t i = 1; i < Words; ++i) p.word[i] = number * (2 * i + 1);
    return p;
}

}  // namespace tact::stress
