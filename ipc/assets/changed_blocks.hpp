// Which blocks of a buffer were written since somebody last asked, as ranges to upload.
//
// A range is whole blocks. Ranges with few untouched blocks between them are joined, where sending those
// costs less than one more call. Marks are bytes: one store each, which no other waits for.
//
// Memory   a byte a block; nothing is allocated after construction.
// Thread   belongs to one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace tact {

struct MeshRange {
    std::uint32_t first, count;  // in elements
    friend bool operator==(const MeshRange&, const MeshRange&) = default;
};

class ChangedBlocks {
public:
    // Blocks of 2^shift elements; up to `join` untouched blocks are sent along. Nothing is marked.
    ChangedBlocks(std::size_t elements, std::uint32_t shift, std::uint32_t join)
        : elements_(elements), shift_(shift), join_(join) {
        const std::size_t blocks = (elements >> shift) + 1;
        flag_.assign((blocks + 63) / 64 * 64, 0);
        range_.resize(blocks / (join + 1U) + 2);
    }

    void mark(std::size_t element) noexcept { flag_[element >> shift_] = 1; }
    void mark(std::size_t first, std::size_t end) noexcept {
        if (first >= end) return;
        std::memset(&flag_[first >> shift_], 1, ((end - 1) >> shift_) - (first >> shift_) + 1);
    }

    // Rising, apart. Holds until the next call; forgets the marks.
    std::span<const MeshRange> take() noexcept {
        std::size_t count = 0, first = 0, end = 0;  // of the range that grows, in blocks
        const auto close = [&] {
            if (end == 0) return;
            const std::size_t a = first << shift_, b = std::min(elements_, end << shift_);
            if (a < b) range_[count++] = {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b - a)};
        };
        for (std::size_t at = 0; at < flag_.size(); at += 64) {
            std::uint64_t left = take_64(&flag_[at]);
            while (left != 0) {
                const int bit = std::countr_zero(left);
                const int run = std::countr_one(left >> bit);
                const std::size_t a = at + static_cast<std::size_t>(bit);
                if (end == 0 || a > end + join_) {
                    close();
                    first = a;
                }
                end = a + static_cast<std::size_t>(run);
                if (bit + run == 64) break;
                left &= ~std::uint64_t{0} << (bit + run);
            }
        }
        close();
        return {range_.data(), count};
    }

private:
    // The flags as bits, the first lowest; clears them.
    static std::uint64_t take_64(std::uint8_t* flags) noexcept {
        std::uint64_t eight[8], any = 0, bits = 0;
        std::memcpy(eight, flags, 64);
        for (const std::uint64_t e : eight) any |= e;
        if (any == 0) return 0;
        std::memset(flags, 0, 64);
        // Byte i of a word has its bit 0 moved to bit 56 + i; none of the products overlap.
        for (int i = 0; i < 8; ++i) bits |= (eight[i] * 0x0102040810204080U >> 56) << (8 * i);
        return bits;
    }

    std::size_t elements_;
    std::uint32_t shift_, join_;
    std::vector<std::uint8_t> flag_;
    std::vector<MeshRange> range_;
};

}  // namespace tact
