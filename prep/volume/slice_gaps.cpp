#include "prep/volume/slice_gaps.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr double kEqual = 0.03, kMissing = 1.5;

std::vector<SlicePart> parts_of(const std::vector<double>& gap) {
    std::vector<SlicePart> parts;
    for (std::size_t i = 0; i < gap.size();) {
        std::size_t end = i + 1;
        while (end < gap.size() && std::abs(gap[end] - gap[i]) < kEqual * gap[i]) ++end;
        if (end - i >= kPartGaps) {
            double sum = 0.0;
            for (std::size_t k = i; k < end; ++k) sum += gap[k];
            const SlicePart part{i, end - i, sum / static_cast<double>(end - i)};
            // Interrupted by a gap, or by an uneven slice: the same part goes on.
            if (!parts.empty() &&
                std::abs(parts.back().spacing_mm - part.spacing_mm) < kEqual * part.spacing_mm)
                parts.back().gaps = end - parts.back().first;
            else
                parts.push_back(part);
        }
        i = end;
    }
    return parts;
}

// Of the nearest part; the finer one of two.
double spacing_beside(std::size_t gap, const std::vector<SlicePart>& parts, double otherwise) {
    double best = otherwise;
    std::size_t nearest = static_cast<std::size_t>(-1);
    for (const SlicePart& p : parts) {
        const std::size_t end = p.first + p.gaps - 1;
        const std::size_t away = gap < p.first ? p.first - gap : gap > end ? gap - end : 0;
        if (away < nearest || (away == nearest && p.spacing_mm < best)) best = p.spacing_mm, nearest = away;
    }
    return best;
}

}  // namespace

SliceGaps slice_gaps(std::span<const double> at_mm) {
    SliceGaps out;
    std::vector<double> gap;
    for (std::size_t i = 0; i + 1 < at_mm.size(); ++i) gap.push_back(at_mm[i + 1] - at_mm[i]);
    if (gap.empty()) return out;
    std::vector<double> sorted = gap;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    out.typical_mm = sorted[sorted.size() / 2];
    out.parts = parts_of(gap);
    for (std::size_t i = 0; i < gap.size(); ++i) {
        const double expected = spacing_beside(i, out.parts, out.typical_mm);
        if (expected > 0.0 && gap[i] >= kMissing * expected)
            out.missing.push_back({i, static_cast<std::size_t>(std::lround(gap[i] / expected)) - 1});
    }
    return out;
}

}  // namespace tact
