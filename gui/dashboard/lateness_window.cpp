#include "gui/dashboard/lateness_window.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

LatenessMetrics lateness_metrics(const LatenessWindow::Counts& counts, std::uint64_t total,
                                 std::uint64_t max_ns) {
    const auto at = [&](double p) {
        return static_cast<std::int64_t>(DurationHistogram::percentile_ns(counts.data(), total, max_ns, p));
    };
    return {total, at(0.5), at(0.99), at(0.999), static_cast<std::int64_t>(max_ns)};
}

}  // namespace

LatenessWindow::LatenessWindow() : records_(kKept) {}

void LatenessWindow::clear() {
    next_ = kept_ = 0;
    recent_.fill(0);
    recent_s_ = 0.0;
    whole_metrics_ = recent_metrics_ = {};
}

const LatenessWindow::Record& LatenessWindow::record(std::size_t back) const {
    return records_[(next_ + kKept - 1 - back) % kKept];
}

void LatenessWindow::add(const LatenessTopic& topic) {
    if (kept_ > 0) {
        const Record& before = record(0);
        if (topic.total < before.total || topic.max_ns < before.max_ns ||
            topic.taken_at_ns < before.taken_at_ns ||
            !std::equal(before.counts.begin(), before.counts.end(), topic.counts,
                        [](std::uint64_t a, std::uint64_t b) { return a <= b; }))
            clear();
    }
    Record& r = records_[next_];
    r.taken_at_ns = topic.taken_at_ns;
    r.total = topic.total;
    r.max_ns = topic.max_ns;
    std::copy_n(topic.counts, r.counts.size(), r.counts.begin());
    next_ = (next_ + 1) % kKept;
    kept_ = std::min(kept_ + 1, kKept);
    whole_metrics_ = lateness_metrics(r.counts, r.total, r.max_ns);
    if (kept_ == 1) return;
    const Record& first = record(kept_ - 1);
    for (std::size_t i = 0; i < recent_.size(); ++i) recent_[i] = r.counts[i] - first.counts[i];
    recent_s_ = 1e-9 * static_cast<double>(r.taken_at_ns - first.taken_at_ns);
    const std::uint64_t most =
        r.max_ns > first.max_ns ? r.max_ns : DurationHistogram::longest_ns(recent_.data(), r.max_ns);
    recent_metrics_ = lateness_metrics(recent_, r.total - first.total, most);
}

double LatenessBars::edge_ns(std::size_t bar) {
    return kLeastNs * std::exp2(static_cast<double>(bar) / static_cast<double>(kPerOctave));
}

LatenessBars::LatenessBars(const LatenessWindow::Counts& counts) {
    // Four of an octave's 16 buckets make a bar. Bucket edges are linear within an octave, close enough to the bar's.
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        const double ns = static_cast<double>(DurationHistogram::upper_ns(i));
        const double place =
            std::floor(static_cast<double>(kPerOctave) * std::log2(std::max(ns / kLeastNs, 1.0)));
        const auto bar = std::min(static_cast<std::size_t>(place), kBars - 1);
        count[bar] += counts[i];
        most = std::max(most, count[bar]);
        last = std::max(last, bar);
    }
}

}  // namespace tact
