#include "prep/drilling/bone_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tact {
namespace {

constexpr std::size_t kBins = 256, kFineBins = 8192;
constexpr double kSolidShare = 0.98, kCounted = 0.9995;

template <class Take>
void each_value(const Scan& scan, const Progress& progress, double from, const Take& take) {
    std::vector<float> pixels(scan.pixels());
    for (std::uint32_t k = 0; k < scan.slice.size(); ++k) {
        report(progress, from + 0.5 * k / static_cast<double>(scan.slice.size()),
               "finding the values of bone");
        scan.read(k, pixels);
        for (const float v : pixels) take(static_cast<double>(v));
    }
}

// The last bins of the first two of three classes.
std::pair<std::size_t, std::size_t> three_classes(const std::vector<double>& count) {
    std::vector<double> weight(kBins), first(kBins);
    double w = 0.0, m = 0.0;
    for (std::size_t i = 0; i < kBins; ++i) {
        weight[i] = w += count[i];
        first[i] = m += count[i] * static_cast<double>(i);
    }
    const auto spread = [&](std::size_t from,
                            std::size_t to) {  // bins in (from, to]; from kBins: from the first
        const bool begins = from == kBins;
        const double n = weight[to] - (begins ? 0.0 : weight[from]),
                     sum = first[to] - (begins ? 0.0 : first[from]);
        return n > 0.0 ? sum * sum / n : 0.0;
    };
    std::pair<std::size_t, std::size_t> best{0, 1};
    double most = -1.0;
    for (std::size_t a = 0; a + 2 < kBins; ++a)
        for (std::size_t b = a + 1; b + 1 < kBins; ++b) {
            const double between = spread(kBins, a) + spread(a, b) + spread(b, kBins - 1);
            if (between > most * (1.0 + 1e-12)) most = between, best = {a, b};
        }
    return best;
}

}  // namespace

std::optional<ScanHistogram> scan_histogram(const Scan& scan, const Progress& progress) {
    double low = 1e300, high = -1e300;
    each_value(scan, progress, 0.0, [&](double v) { low = std::min(low, v), high = std::max(high, v); });
    if (!(high > low)) return std::nullopt;
    const double fine = (high - low) / static_cast<double>(kFineBins);
    std::vector<double> fine_count(kFineBins, 0.0);
    each_value(scan, progress, 0.5, [&](double v) {
        ++fine_count[std::min(static_cast<std::size_t>((v - low) / fine), kFineBins - 1)];
    });
    // Metal, far above all else, would leave too few classes for the rest.
    double total = 0.0, sum_of_fine = 0.0;
    for (const double n : fine_count) total += n;
    std::size_t top = 0;
    while (top + 1 < kFineBins && (sum_of_fine += fine_count[top]) < kCounted * total) ++top;
    std::vector<double> count(kBins, 0.0);
    for (std::size_t f = 0; f < kFineBins; ++f)
        count[std::min(f * kBins / (top + 1), kBins - 1)] += fine_count[f];
    return ScanHistogram{low, high, low + fine * static_cast<double>(top + 1), std::move(count)};
}

bool in_hounsfield(const Scan& scan, double low) {
    return scan.values == ScanValues::hounsfield || (scan.values == ScanValues::number && low <= kAirHu);
}

ProposedBone propose_bone(const ScanHistogram& histogram) {
    const std::vector<double>& count = histogram.count;
    const double low = histogram.low, bin = (histogram.high - low) / static_cast<double>(kBins);
    const std::size_t last = three_classes(count).second;
    double above = 0.0, all = 0.0;
    for (std::size_t i = 0; i < kBins; ++i) {
        all += count[i];
        if (i > last) above += count[i];
    }
    ProposedBone out;
    out.threshold = low + bin * static_cast<double>(last + 1);
    out.share_above = above / all;
    double sum = 0.0;
    std::size_t i = last + 1;
    for (; i + 1 < kBins; ++i) {
        sum += count[i];
        if (sum >= kSolidShare * above) break;
    }
    out.solid = std::max(low + bin * static_cast<double>(i + 1), out.threshold + bin);
    return out;
}

}  // namespace tact
