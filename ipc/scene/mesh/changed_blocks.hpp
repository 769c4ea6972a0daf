// Tracks the written blocks of a buffer, as ranges to upload.
//
// A range consists of whole blocks. Ranges separated by few untouched blocks are joined, where sending
// these costs less than another call. Marks are bits, so that the marks of a large mesh stay in the L1
// cache.
//
// Settled  the content that the owner can restore; unsettled() tells which blocks may differ from it: those
//          marked since. A mark also counts until it is taken, so a block is rather listed once too often.
//
// Memory   two bits per block, and the runs of the worst case; no allocation after construction
// Thread   belongs to one
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tact {

struct MeshRange {
    std::uint32_t first, count;  // in elements
    friend bool operator==(const MeshRange&, const MeshRange&) = default;
};

class ChangedBlocks {
public:
    // Blocks of 2^shift elements; up to `join` untouched blocks are sent too. Starts settled, without marks.
    ChangedBlocks(std::size_t elements, std::uint32_t shift, std::uint32_t join)
        : elements_(elements), shift_(shift), join_(join) {
        const std::size_t blocks = (elements >> shift) + 1;
        mark_.assign(blocks / 64 + 2, 0);  // the last word stays empty, so that every run ends
        unsettled_.assign(mark_.size(), 0);
        const std::size_t runs = blocks / 2 + 1;
        start_.resize(runs + kSlack);
        end_.resize(runs + kSlack);
        range_.resize(runs);
    }

    void mark(std::size_t element) noexcept {
        const std::size_t block = element >> shift_;
        mark_[block / 64] |= std::uint64_t{1} << block % 64;
    }
    // Three elements from `first` on, rarely in two blocks.
    void mark_triangle(std::size_t first) noexcept {
        mark(first);
        if (((first ^ (first + 2)) >> shift_) != 0) mark(first + 2);
    }
    void mark(std::size_t first, std::size_t end) noexcept {
        if (first >= end) return;
        const std::size_t a = first >> shift_, b = (end - 1) >> shift_;
        const std::uint64_t from = ~std::uint64_t{0} << a % 64, to = ~std::uint64_t{0} >> (63 - b % 64);
        if (a / 64 == b / 64) {
            mark_[a / 64] |= from & to;
            return;
        }
        mark_[a / 64] |= from;
        for (std::size_t i = a / 64 + 1; i < b / 64; ++i) mark_[i] = ~std::uint64_t{0};
        mark_[b / 64] |= to;
    }

    // Marks bit b of `bits`: block 64 word + b.
    void mark_word(std::size_t word, std::uint64_t bits) noexcept { mark_[word] |= bits; }

    // The next take() returns all elements. They stay settled.
    void send_all() noexcept { all_ = true; }

    // The current content is the settled one. Marks that are still to be taken stay unsettled.
    void settle() noexcept { std::fill(unsettled_.begin(), unsettled_.end(), 0); }
    // Bit b: block 64 word + b may differ from the settled content. 0 past the last word.
    [[nodiscard]] std::uint64_t unsettled(std::size_t word) const noexcept {
        return word < mark_.size() ? mark_[word] | unsettled_[word] : 0;
    }
    [[nodiscard]] std::size_t unsettled_blocks() const noexcept {
        std::size_t count = 0;
        for (std::size_t i = 0; i < mark_.size(); ++i)
            count += static_cast<std::size_t>(std::popcount(mark_[i] | unsettled_[i]));
        return count;
    }

    // Increasing and disjoint. Valid until the next call; clears the marks.
    std::span<const MeshRange> take() noexcept {
        const std::size_t runs = take_runs();
        if (all_) {
            all_ = false;
            range_[0] = {0, static_cast<std::uint32_t>(elements_)};
            return {range_.data(), elements_ != 0 ? 1U : 0U};
        }
        if (runs == 0) return {};
        const auto range = [&](std::uint32_t first, std::uint32_t end) {
            const std::size_t a = std::size_t{first} << shift_,
                              b = std::min(elements_, std::size_t{end} << shift_);
            return MeshRange{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b - a)};
        };
        // The gap before a run alone decides whether the run starts a range, so no branch is needed.
        std::size_t count = 0;
        std::uint32_t first = start_[0];
        for (std::size_t i = 1; i < runs; ++i) {
            range_[count] = range(first, end_[i - 1]);
            const bool apart = start_[i] - end_[i - 1] > join_;
            count += apart ? 1 : 0;
            first = apart ? start_[i] : first;
        }
        const MeshRange last = range(first, end_[runs - 1]);
        if (last.count != 0) range_[count++] = last;
        return {range_.data(), count};
    }

private:
    static constexpr std::size_t kSlack = 2;

    // Lists the starts and ends of runs of marked blocks in start_ and end_, and clears the marks. Few
    // words have more than two starts when marks are sparse, and none when they are dense: the first two
    // are handled without a branch.
    std::size_t take_runs() noexcept {
        std::size_t starts = 0, ends = 0;
        const auto list = [](std::uint64_t bits, std::uint32_t at, std::uint32_t* to, std::size_t& count) {
            for (int i = 0; i < 2; ++i) {
                to[count] = at + static_cast<std::uint32_t>(std::countr_zero(bits));
                count += bits != 0 ? 1 : 0;
                bits &= bits - 1;
            }
            for (; bits != 0; bits &= bits - 1)
                to[count++] = at + static_cast<std::uint32_t>(std::countr_zero(bits));
        };
        std::uint64_t before = 0;  // highest bit of the previous word, as the lowest bit
        for (std::size_t i = 0; i < mark_.size(); ++i) {
            const std::uint64_t now = mark_[i], shifted = now << 1 | before;
            const auto at = static_cast<std::uint32_t>(64 * i);
            list(now & ~shifted, at, start_.data(), starts);
            list(~now & shifted, at, end_.data(), ends);
            before = now >> 63;
            unsettled_[i] |= now;
            mark_[i] = 0;
        }
        return starts;
    }

    std::size_t elements_;
    std::uint32_t shift_, join_;
    bool all_ = false;
    std::vector<std::uint64_t> mark_, unsettled_;
    std::vector<std::uint32_t> start_, end_;  // of runs, in blocks
    std::vector<MeshRange> range_;
};

}  // namespace tact
