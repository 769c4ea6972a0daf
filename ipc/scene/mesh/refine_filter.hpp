// Permitted error at a distance from the probe, which controls the refinement of the surface.
//
// Distance  Chebyshev, max(|dx|,|dy|,|dz|), in model metres. Up to radius_m no error is permitted: full
//           detail
// Form      beyond it piecewise linear and never decreasing, constant beyond its last point (nested
//           frustums). A bell has its points on 1 - exp(-x²)
// Thread    any; a value
// Errors    none: frustums() corrects any input
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace tact {

class RefineFilter {
public:
    static constexpr std::size_t kPointsMax = 16;
    struct Point {
        float distance_m, error_m;
    };

    RefineFilter() = default;  // full detail everywhere
    // Sorts the points; drops non-finite and negative ones, and raises decreasing errors.
    static RefineFilter frustums(float radius_m, std::span<const Point> points) {
        RefineFilter made;
        made.point_[0] = {std::isfinite(radius_m) && radius_m > 0.0F ? radius_m : 0.0F, 0.0F};
        made.count_ = 1;
        for (const Point& p : points) {
            if (made.count_ == kPointsMax) break;
            if (!std::isfinite(p.distance_m) || !std::isfinite(p.error_m)) continue;
            if (p.distance_m < made.point_[0].distance_m || p.error_m < 0.0F) continue;
            made.point_[made.count_++] = p;
        }
        const auto end = made.point_.begin() + static_cast<std::ptrdiff_t>(made.count_);
        std::stable_sort(made.point_.begin() + 1, end,
                         [](const Point& a, const Point& b) { return a.distance_m < b.distance_m; });
        for (std::size_t i = 1; i < made.count_; ++i)
            made.point_[i].error_m = std::max(made.point_[i].error_m, made.point_[i - 1].error_m);
        made.allows_.fill(kEverywhere);
        for (std::size_t i = 1; i < made.count_; ++i) {
            const Point &a = made.point_[i - 1], &b = made.point_[i];
            made.allows_[i] = b.error_m;
            const float rise = b.error_m - a.error_m;
            made.per_error_[i] = rise > 0.0F ? (b.distance_m - a.distance_m) / rise : 0.0F;
        }
        return made;
    }
    // error_far_m at large distance; 1 - 1/e of it at radius_m + width_m.
    static RefineFilter bell(float radius_m, float width_m, float error_far_m) {
        std::array<Point, kPointsMax - 1> point{};
        for (std::size_t i = 0; i < point.size(); ++i) {
            const float x = 2.5F * static_cast<float>(i + 1) / static_cast<float>(point.size());
            point[i] = {radius_m + x * width_m, error_far_m * (1.0F - std::exp(-x * x))};
        }
        return frustums(radius_m, point);
    }

    // Approximation of a bell by three nested frustums.
    static RefineFilter multiple_frustum(float radius_m, float width_m, float error_far_m) {
        const std::array<Point, 4> corner{{{radius_m, 0.1F * error_far_m},
                                           {radius_m + 0.5F * width_m, 0.4F * error_far_m},
                                           {radius_m + width_m, 0.7F * error_far_m},
                                           {radius_m + 2.0F * width_m, error_far_m}}};
        return frustums(radius_m, corner);
    }

    [[nodiscard]] float radius_m() const noexcept { return count_ > 0 ? point_[0].distance_m : kEverywhere; }
    [[nodiscard]] std::span<const Point> points() const noexcept { return std::span(point_).first(count_); }
    [[nodiscard]] float allowed_m(float distance_m) const noexcept {
        if (count_ == 0 || distance_m <= point_[0].distance_m) return 0.0F;
        for (std::size_t i = 1; i < count_; ++i) {
            const Point &a = point_[i - 1], &b = point_[i];
            if (distance_m > b.distance_m) continue;
            const float run = b.distance_m - a.distance_m;
            const float part = run > 0.0F ? (distance_m - a.distance_m) / run : 1.0F;
            return a.error_m + part * (b.error_m - a.error_m);
        }
        return point_[count_ - 1].error_m;
    }
    // Distance below which an error is not permitted: allowed_m(d) < error_m exactly if d is below it.
    [[nodiscard]] float distance_m(float error_m) const noexcept {
        if (count_ == 0) return kEverywhere;
        std::size_t i = 1;  // the first point that permits it; used at every split and merge, so branch-free
        for (std::size_t k = 1; k < kPointsMax; ++k) i += error_m > allows_[k] ? 1 : 0;
        if (i >= count_) return kEverywhere;
        const Point& a = point_[i - 1];
        return a.distance_m + (error_m - a.error_m) * per_error_[i];
    }

private:
    static constexpr float kEverywhere = std::numeric_limits<float>::max();
    std::array<Point, kPointsMax> point_{};
    std::size_t count_ = 0;
    std::array<float, kPointsMax> allows_{};     // errors of the points; infinite beyond the last
    std::array<float, kPointsMax> per_error_{};  // distance per additional error, up to each point
};

// The user's choice of a filter; the knob sets the radius of full detail.
struct FilterForm {
    enum class Shape : std::uint8_t { bell, multiple_frustum };
    static constexpr float kLeast = 0.05F, kMost = 20.0F;  // limits of both numbers

    Shape shape = Shape::bell;
    float width = 1.0F;      // width of the falloff beyond the radius, in radii
    float error_far = 0.5F;  // permitted at large distance, in radii

    [[nodiscard]] bool possible() const noexcept {
        return shape <= Shape::multiple_frustum && width >= kLeast && width <= kMost && error_far >= kLeast &&
               error_far <= kMost;
    }
    [[nodiscard]] RefineFilter filter(float radius_m) const {
        return shape == Shape::bell
                   ? RefineFilter::bell(radius_m, width * radius_m, error_far * radius_m)
                   : RefineFilter::multiple_frustum(radius_m, width * radius_m, error_far * radius_m);
    }
    [[nodiscard]] bool operator==(const FilterForm&) const = default;
};

}  // namespace tact
