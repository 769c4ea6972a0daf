// Log-linear histogram of durations: constant-time insert, 6 % bucket width, no allocation.
//
// Range   0 to about 4.3 s; longer durations count in the last bucket. 32 octaves of 16 buckets, in ns.
// Thread  one writer. Copies of counts may be read elsewhere (ipc/topics/lateness.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "ipc/base/clock.hpp"

namespace tact {

class DurationHistogram {
public:
    static constexpr std::size_t kSub = 16;
    static constexpr std::size_t kBuckets = kSub * 30;

    static constexpr std::size_t bucket_of(std::uint64_t ns) noexcept {
        if (ns < kSub) return static_cast<std::size_t>(ns);
        const auto octave =
            static_cast<std::size_t>(std::bit_width(ns)) - 5;  // ns in [16 << octave, 32 << octave)
        const auto sub = static_cast<std::size_t>(ns >> octave) - kSub;
        return std::min((octave + 1) * kSub + sub, kBuckets - 1);
    }
    // Upper edge of the bucket, so that a percentile is never understated.
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
    // The same for external counts; p in [0, 1].
    static std::uint64_t percentile_ns(const std::uint64_t* counts, std::uint64_t total, std::uint64_t max_ns,
                                       double p) noexcept {
        if (total == 0) return 0;
        const auto rank = static_cast<std::uint64_t>(p * static_cast<double>(total - 1)) + 1;
        std::uint64_t seen = 0;
        for (std::size_t b = 0; b < kBuckets; ++b) {
            seen += counts[b];
            if (seen >= rank) return std::min(upper_ns(b), max_ns);
        }
        return max_ns;
    }

private:
    std::array<std::uint64_t, kBuckets> counts_{};
    std::uint64_t total_ = 0;
    std::uint64_t max_ns_ = 0;
};

}  // namespace tact
