// Lateness of the whole run and of its last minute, from the counts that the controller publishes once a second.
//
// Counts and buckets are the controller's (DurationHistogram). The last minute is the newest record minus the record
// of
// a minute earlier, so both are the same measurement.
// Memory   kKept records, allocated once.  Thread  one; plain arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/topics/health.hpp"

namespace tact {

struct LatenessMetrics {
    std::uint64_t cycles = 0;
    std::int64_t p50_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;
};

class LatenessWindow {
public:
    using Counts = std::array<std::uint64_t, DurationHistogram::kBuckets>;
    static constexpr std::size_t kKept = 61;  // a minute, and the record before it

    LatenessWindow();
    // Adds a record. If the counts fall, another run has begun and the history is cleared.
    void add(const LatenessTopic& record);
    void clear();

    [[nodiscard]] bool empty() const { return kept_ == 0; }
    [[nodiscard]] const Counts& whole() const { return at(0); }
    [[nodiscard]] const Counts& recent() const { return recent_; }
    [[nodiscard]] double recent_s() const { return recent_s_; }  // duration of the recent window
    [[nodiscard]] const LatenessMetrics& whole_metrics() const { return whole_metrics_; }
    // max_ns is rounded to a bucket's upper edge (6 %) unless it is the maximum of the whole run.
    [[nodiscard]] const LatenessMetrics& recent_metrics() const { return recent_metrics_; }
    [[nodiscard]] std::size_t memory_bytes() const { return records_.capacity() * sizeof(Record); }

private:
    struct Record {
        std::int64_t taken_at_ns = 0;
        std::uint64_t total = 0, max_ns = 0;
        Counts counts{};
    };
    [[nodiscard]] const Record& record(std::size_t back) const;
    [[nodiscard]] const Counts& at(std::size_t back) const { return record(back).counts; }

    std::vector<Record> records_;  // a ring
    std::size_t next_ = 0, kept_ = 0;
    Counts recent_{};
    double recent_s_ = 0.0;
    LatenessMetrics whole_metrics_, recent_metrics_;
};

// Bucket counts gathered into bars of a quarter octave, from the first to beyond the last edge.
struct LatenessBars {
    static constexpr std::size_t kBars = 72;  // 1 us to 0.26 s
    static constexpr std::size_t kPerOctave = 4;
    static constexpr double kLeastNs = 1024.0;  // smaller values count in the first bar
    std::array<std::uint64_t, kBars> count{};
    std::uint64_t most = 0;  // highest bar
    std::size_t last = 0;    // the last bar that is not empty

    explicit LatenessBars(const LatenessWindow::Counts& counts);
    [[nodiscard]] static double edge_ns(std::size_t bar);  // lower edge
};

}  // namespace tact
