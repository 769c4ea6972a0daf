#include "prep/mesh/near_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact {
namespace {

constexpr std::int64_t kSide = std::int64_t{1} << 20;  // maximum number of cells along an axis
constexpr std::uint32_t kLookMax = 512;

struct Entry {
    std::int64_t cell;  // x fastest
    std::uint32_t point;
};

}  // namespace

// Cells are as wide as the distance; points are sorted by cell. The neighbours of a cell are three adjacent cells in
// each of nine rows, so nine cursors that only move forward find them.
void near_pairs(std::span<const Eigen::Vector3f> point, float distance, std::uint32_t count,
                const std::function<void(std::uint32_t, const std::vector<std::uint32_t>&)>& take) {
    if (point.empty() || !(distance > 0.0F) || count == 0) return;
    Eigen::Vector3f low = point[0], high = point[0];
    for (const Eigen::Vector3f& p : point) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const float cell = std::max(distance, (high - low).maxCoeff() / static_cast<float>(kSide - 3));
    const auto place = [&](float x, float from) {
        return 1 + static_cast<std::int64_t>(std::floor((x - from) / cell));
    };
    std::vector<Entry> sorted(point.size());
    for (std::uint32_t i = 0; i < point.size(); ++i) {
        const Eigen::Vector3f& p = point[i];
        sorted[i] = {(place(p.z(), low.z()) * kSide + place(p.y(), low.y())) * kSide + place(p.x(), low.x()),
                     i};
    }
    std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
    });
    std::array<std::size_t, 9> cursor{};
    std::vector<std::pair<float, std::uint32_t>> found;
    std::vector<std::uint32_t> near;
    for (const Entry& self : sorted) {
        found.clear();
        std::uint32_t looks = 0;
        for (std::size_t row = 0; row < 9; ++row) {
            const std::int64_t middle = self.cell + ((static_cast<std::int64_t>(row) / 3 - 1) * kSide +
                                                     static_cast<std::int64_t>(row) % 3 - 1) *
                                                        kSide;
            std::size_t& from = cursor[row];
            while (from < sorted.size() && sorted[from].cell < middle - 1) ++from;
            for (std::size_t k = from; k < sorted.size() && sorted[k].cell <= middle + 1; ++k) {
                if (++looks > kLookMax) break;
                const std::uint32_t other = sorted[k].point;
                const float square = (point[other] - point[self.point]).squaredNorm();
                if (other > self.point && square <= distance * distance) found.push_back({square, other});
            }
        }
        if (found.empty()) continue;
        std::sort(found.begin(), found.end());
        if (found.size() > count) found.resize(count);
        near.clear();
        for (const auto& [square, other] : found) near.push_back(other);
        take(self.point, near);
    }
}

}  // namespace tact
