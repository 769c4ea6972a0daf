// A priority queue of pairs for costs that need no exact order: push and pop take constant time.
//
// Buckets are half an octave wide (exponent and one bit of the mantissa); within a bucket the last pair in is the
// first out. So the cost of a popped pair is at most 1.5 times the lowest. Chunks are recycled, so memory follows the
// largest number of queued pairs. Repeats exactly.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include "ipc/base/huge_pages.hpp"

namespace tact {

struct QueuedPair {
    std::uint32_t u, v, stamp;
};

class BucketQueue {
public:
    BucketQueue() { head_.fill(kNone); }

    void push(float cost, const QueuedPair& pair) {  // cost >= 0
        const std::uint32_t bucket = std::bit_cast<std::uint32_t>(cost) >> kDropBits;
        std::uint32_t chunk = head_[bucket];
        if (chunk == kNone || chunks_[chunk].used == kChunk) {
            const std::uint32_t fresh = take();
            chunks_[fresh].next = chunk;
            head_[bucket] = chunk = fresh;
            word_[bucket >> 6U] |= std::uint64_t{1} << (bucket & 63U);
        }
        Chunk& c = chunks_[chunk];
        c.pair[c.used++] = pair;
        if (bucket >> 6U < low_) low_ = bucket >> 6U;
    }

    // False if empty. `cost` becomes the lower bound of the pair's bucket.
    bool pop(QueuedPair& pair, float& cost) {
        while (low_ < kWords && word_[low_] == 0) ++low_;
        if (low_ == kWords) return false;
        const std::uint32_t bucket = low_ * 64 + static_cast<std::uint32_t>(std::countr_zero(word_[low_]));
        const std::uint32_t chunk = head_[bucket];
        Chunk& c = chunks_[chunk];
        pair = c.pair[--c.used];
        cost = std::bit_cast<float>(bucket << kDropBits);
        if (c.used == 0) {
            head_[bucket] = c.next;
            if (c.next == kNone) word_[low_] &= ~(std::uint64_t{1} << (bucket & 63U));
            c.next = free_;
            free_ = chunk;
        }
        return true;
    }
    // True if a pair of this cost belongs to the bucket that begins at `due`, or to a lower one.
    [[nodiscard]] static bool in_bucket(float cost, float due) {
        return std::bit_cast<std::uint32_t>(cost) >> kDropBits <= std::bit_cast<std::uint32_t>(due) >>
               kDropBits;
    }
    // The pair that pop() is likely to return some calls later, for prefetching.
    [[nodiscard]] const QueuedPair* ahead(std::uint32_t places) const {
        if (low_ >= kWords || word_[low_] == 0) return nullptr;
        const std::uint32_t bucket = low_ * 64 + static_cast<std::uint32_t>(std::countr_zero(word_[low_]));
        const Chunk& c = chunks_[head_[bucket]];
        return c.used > places ? &c.pair[c.used - 1 - places] : nullptr;
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return chunks_.capacity() * sizeof(Chunk) + sizeof(*this);
    }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;
    static constexpr std::uint32_t kDropBits = 22;  // of 31: keeps 8 exponent bits and 1 mantissa bit
    static constexpr std::uint32_t kBuckets = 1U << (31 - kDropBits);
    static constexpr std::uint32_t kWords = kBuckets / 64;
    static constexpr std::uint32_t kChunk = 21;
    struct Chunk {
        std::uint32_t next, used;
        std::array<QueuedPair, kChunk> pair;
    };

    std::uint32_t take() {
        if (free_ == kNone) {
            chunks_.push_back({});
            return static_cast<std::uint32_t>(chunks_.size() - 1);
        }
        const std::uint32_t chunk = free_;
        free_ = chunks_[chunk].next;
        chunks_[chunk].used = 0;
        return chunk;
    }

    std::array<std::uint32_t, kBuckets> head_{};
    std::array<std::uint64_t, kWords> word_{};  // bit set: the bucket has pairs
    std::uint32_t low_ = kWords;                // no lower word has a bit set
    std::uint32_t free_ = kNone;
    HugeVector<Chunk> chunks_;
};

}  // namespace tact
