// Log-linear histogram of durations: constant-time insert, 6 % bucket width, no allocation.
//
// Range   0 to 8.6 s (kRangeNs): 16 buckets of 1 ns, then 29 octaves of 16 buckets each. Anything longer counts in the
//         last bucket.
// Thread  one writer. Copies of counts may be read elsewhere (LatenessTopic in ipc/topics/health.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ipc/base/clock.hpp"

namespace tact {

class DurationHistogram {
public:
    static constexpr std::size_t kSub = 16;
    static constexpr std::size_t kOctaves = 29;
    static constexpr std::size_t kBuckets = kSub * (1 + kOctaves);
    // The last bucket ends here, for durations within the range.
    static constexpr std::uint64_t kRangeNs = static_cast<std::uint64_t>(kSub) << kOctaves;

    static constexpr std::size_t bucket_of(std::uint64_t ns) noexcept {
        if (ns < kSub) return static_cast<std::size_t>(ns);
        const auto octave =
            static_cast<std::size_t>(std::bit_width(ns)) - 5;  // ns in [16 << octave, 32 << octave)
        const auto sub = static_cast<std::size_t>(ns >> octave) - kSub;
        return std::min((octave + 1) * kSub + sub, kBuckets - 1);
    }
    // Upper edge of the bucket. The last bucket holds everything longer too.
    static constexpr std::uint64_t upper_ns(std::size_t bucket) noexcept {
        if (bucket < kSub) return bucket;
        const std::size_t octave = bucket / kSub - 1;
        return ((kSub + bucket % kSub + 1) << octave) - 1;
    }

    void add(Duration d) noexcept TACT_RT {
        const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(d.count(), 0));
        ++counts_[bucket_of(ns)];
        ++total_;
        max_ns_ = std::max(max_ns_, ns);
    }
    void clear() noexcept TACT_RT { *this = {}; }

    [[nodiscard]] const std::array<std::uint64_t, kBuckets>& counts() const noexcept { return counts_; }
    [[nodiscard]] std::uint64_t total() const noexcept { return total_; }
    [[nodiscard]] std::uint64_t max_ns() const noexcept { return max_ns_; }
    [[nodiscard]] std::uint64_t percentile_ns(double p) const noexcept {
        return percentile_ns(counts_.data(), total_, max_ns_, p);
    }
    // The same over counts from elsewhere; max_ns is at least their longest duration. p in [0, 1]. Never below the
    // ceil(p total)-th shortest duration, nor more than a bucket's width above it within the range; beyond it, max_ns.
    static std::uint64_t percentile_ns(const std::uint64_t* counts, std::uint64_t total, std::uint64_t max_ns,
                                       double p) noexcept {
        if (total == 0) return 0;
        const std::uint64_t rank = rank_of(p, total);
        std::uint64_t seen = 0;
        for (std::size_t b = 0; b + 1 < kBuckets; ++b) {
            seen += counts[b];
            if (seen >= rank) return std::min(upper_ns(b), max_ns);
        }
        return max_ns;
    }
    // At least the longest of these counts: the upper edge of the last bucket in use, or max_ns where that is less or the
    // bucket has no upper edge. 0: there are none.
    static std::uint64_t longest_ns(const std::uint64_t* counts, std::uint64_t max_ns) noexcept {
        for (std::size_t b = kBuckets; b-- > 0;)
            if (counts[b] > 0) return b + 1 == kBuckets ? max_ns : std::min(upper_ns(b), max_ns);
        return 0;
    }

private:
    // ceil(p total), from 1 to total. The factor takes back the rounding of p, so that 0.07 of 100 is 7 and not 8.
    static std::uint64_t rank_of(double p, std::uint64_t total) noexcept {
        if (!(p > 0.0)) return 1;
        if (p >= 1.0) return total;
        const double rank = std::ceil(p * static_cast<double>(total) * (1.0 - 0x1p-50));
        return std::clamp<std::uint64_t>(static_cast<std::uint64_t>(rank), 1, total);
    }

    std::array<std::uint64_t, kBuckets> counts_{};
    std::uint64_t total_ = 0;
    std::uint64_t max_ns_ = 0;
};
static_assert(DurationHistogram::upper_ns(DurationHistogram::kBuckets - 1) ==
              DurationHistogram::kRangeNs - 1);
static_assert(DurationHistogram::kRangeNs / 100'000'000 == 85);  // the range in the first lines

}  // namespace tact
