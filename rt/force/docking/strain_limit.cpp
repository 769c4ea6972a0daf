#include "rt/force/docking/strain_limit.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

constexpr int kSweeps = 8;  // of projections onto the half-spaces
constexpr double kCreep =
    1e-3;  // that a pass may rise if more links are near than the list holds, so that they can leave

Vec3 at(const NodeVectors& v, std::uint32_t n) {
    return Eigen::Vector3f(v.x[n], v.y[n], v.z[n]).cast<double>();
}

Vec3 bent_m(const FlexibleParts::Link& link, const NodeVectors& shift_m) {
    return link.rest_m + at(shift_m, link.b) - at(shift_m, link.a);
}

}  // namespace

void StrainLimit::restart(std::span<const float> amplitude_m) noexcept {
    *this = {};
    std::copy(amplitude_m.begin(), amplitude_m.end(), at_m_.begin());
}

// Keeps the largest ones.
void StrainLimit::take(std::size_t link, double strain) noexcept {
    next_strain_ = std::max(next_strain_, strain);
    if (strain <= kMost - kNear) {
        next_others_ = std::max(next_others_, strain);
        return;
    }
    if (next_count_ < kListMost) {
        next_near_[next_count_++] = {.link = link, .strain = strain, .rise = {}};
        return;
    }
    Near& least = *std::min_element(next_near_.begin(), next_near_.end(),
                                    [](const Near& a, const Near& b) { return a.strain < b.strain; });
    next_others_ = std::max(next_others_, std::min(least.strain, strain));
    if (strain > least.strain) least = {.link = link, .strain = strain, .rise = {}};
}

void StrainLimit::measure(const FlexibleParts& parts, const NodeVectors& shift_m,
                          std::size_t before) noexcept {
    for (; next_link_ < parts.links.size() && parts.links[next_link_].b < before; ++next_link_) {
        const FlexibleParts::Link& link = parts.links[next_link_];
        take(next_link_, std::abs(bent_m(link, shift_m).norm() / link.rest_m.norm() - 1.0));
    }
}

void StrainLimit::end_pass(const FlexibleParts& parts, const NodeVectors& shift_m,
                           std::span<const float> amplitude_m) noexcept {
    std::copy(amplitude_m.begin(), amplitude_m.end(), at_m_.begin());
    strain_ = next_strain_;
    others_ = next_others_;
    count_ = next_count_;
    const NormalModes& m = parts.modes;
    for (std::size_t i = 0; i < count_; ++i) {
        near_[i] = next_near_[i];
        const FlexibleParts::Link& link = parts.links[near_[i].link];
        const Vec3 bent = bent_m(link, shift_m);
        const double length = bent.norm(), rest = link.rest_m.norm(), sign = length < rest ? -1.0 : 1.0;
        for (std::size_t k = 0; k < m.count() && length > 0.0; ++k)
            near_[i].rise[k] =
                sign * (m.unit_shift(k, link.b) - m.unit_shift(k, link.a)).dot(bent) / (length * rest);
    }
    next_count_ = next_link_ = 0;
    next_strain_ = next_others_ = 0.0;
}

bool StrainLimit::shorten(const FlexibleParts& parts, std::span<const float> amplitude_m,
                          std::span<double> step_m) const noexcept {
    const std::size_t modes = step_m.size();
    std::array<double, kModesMax> gone{};  // since the measurement
    double risen = 0.0;
    for (std::size_t k = 0; k < modes; ++k) {
        gone[k] = static_cast<double>(amplitude_m[k]) - static_cast<double>(at_m_[k]);
        risen += parts.strain_per_m[k] * std::abs(gone[k]);
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (std::size_t i = 0; i < count_; ++i) {
            double beyond = near_[i].strain - kMost, square = 0.0;
            for (std::size_t k = 0; k < modes; ++k) {
                beyond += near_[i].rise[k] * (gone[k] + step_m[k]);
                square += near_[i].rise[k] * near_[i].rise[k];
            }
            if (!(beyond > 0.0) || !(square > 0.0)) continue;
            for (std::size_t k = 0; k < modes; ++k) step_m[k] -= beyond / square * near_[i].rise[k];
        }
    }
    double may_rise = 0.0;
    for (std::size_t k = 0; k < modes; ++k) may_rise += parts.strain_per_m[k] * std::abs(step_m[k]);
    const double room = std::max(kMost - others_, kCreep) - risen;
    if (!(room > 0.0)) return false;
    if (may_rise > room) {
        for (double& s : step_m) s *= room / may_rise;
    }
    return true;
}

}  // namespace tact
