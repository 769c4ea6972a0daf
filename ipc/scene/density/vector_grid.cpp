#include "ipc/scene/density/vector_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tact {

VectorGrid::VectorGrid(std::vector<Vec3> vectors, const Vec3& low, const Vec3& high)
    : at_(std::move(vectors)),
      low_(low),
      next_(at_.size(), kNone),
      before_(at_.size(), kNone),
      home_(at_.size(), 0) {
    const Vec3 extent = (high - low).cwiseMax(Vec3::Constant(1e-12 * (1.0 + (high - low).maxCoeff())));
    const auto n = static_cast<double>(std::max<std::size_t>(at_.size(), 1));
    // About one vector per cell of the bounding box (molecules fill a part of it). At most 128 cells along an axis.
    width_ = std::max(std::cbrt(extent.prod() / n), extent.maxCoeff() / 128.0);
    for (std::size_t a = 0; a < 3; ++a) {
        count_[a] = std::max(1, static_cast<int>(extent[static_cast<Eigen::Index>(a)] / width_) + 1);
    }
    head_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                     static_cast<std::size_t>(count_[2]),
                 kNone);
    for (std::uint32_t i = 0; i < at_.size(); ++i) link(i);
}

std::array<int, 3> VectorGrid::cell(const Vec3& point) const {
    std::array<int, 3> c{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        const double place =
            std::clamp((point[axis] - low_[axis]) / width_, 0.0, static_cast<double>(count_[a] - 1));
        c[a] = static_cast<int>(place);
    }
    return c;
}

void VectorGrid::link(std::uint32_t index) {
    const std::size_t home = row(cell(at_[index]));
    home_[index] = home;
    before_[index] = kNone;
    next_[index] = head_[home];
    if (head_[home] != kNone) before_[head_[home]] = index;
    head_[home] = index;
}

void VectorGrid::unlink(std::uint32_t index) {
    if (before_[index] != kNone) {
        next_[before_[index]] = next_[index];
    } else {
        head_[home_[index]] = next_[index];
    }
    if (next_[index] != kNone) before_[next_[index]] = before_[index];
}

void VectorGrid::move(std::uint32_t index, const Vec3& to) {
    at_[index] = to;
    if (row(cell(to)) == home_[index]) return;
    unlink(index);
    link(index);
}

std::size_t VectorGrid::nearest(const Vec3& point, std::span<Near> found) const {
    const std::size_t wanted = std::min(found.size(), at_.size());
    std::size_t have = 0;
    if (wanted == 0) return 0;
    const std::array<int, 3> middle = cell(point);
    const int rings = *std::max_element(count_.begin(), count_.end());
    const auto closer = [](const Near& a, const Near& b) {
        return a.distance_2 < b.distance_2 || (a.distance_2 == b.distance_2 && a.index < b.index);
    };
    const auto look = [&](const std::array<int, 3>& c) {
        for (std::uint32_t i = head_[row(c)]; i != kNone; i = next_[i]) {
            const Near candidate{(at_[i] - point).squaredNorm(), i};
            if (have == wanted && !closer(candidate, found[have - 1])) continue;
            std::size_t place = have < wanted ? have++ : have - 1;
            for (; place > 0 && closer(candidate, found[place - 1]); --place) found[place] = found[place - 1];
            found[place] = candidate;
        }
    };
    for (int ring = 0; ring <= rings; ++ring) {
        // Every vector in this ring or beyond is at least this far away; the point may lie outside the box.
        const double reach = (ring - 1) * width_;
        if (have == wanted && reach > 0.0 && found[have - 1].distance_2 < reach * reach) break;
        std::array<int, 3> c{};
        for (c[2] = std::max(0, middle[2] - ring); c[2] <= std::min(count_[2] - 1, middle[2] + ring);
             ++c[2]) {
            for (c[1] = std::max(0, middle[1] - ring); c[1] <= std::min(count_[1] - 1, middle[1] + ring);
                 ++c[1]) {
                const bool shell = std::max(std::abs(c[2] - middle[2]), std::abs(c[1] - middle[1])) == ring;
                const int step = shell || ring == 0 ? 1 : 2 * ring;
                for (c[0] = middle[0] - ring; c[0] <= middle[0] + ring; c[0] += step) {
                    if (c[0] >= 0 && c[0] < count_[0]) look(c);
                }
            }
        }
    }
    return have;
}

}  // namespace tact
