#include "gui/drilling/speed_groups.hpp"

#include <algorithm>
#include <cmath>

namespace tact {

std::size_t speed_group(float share) noexcept {
    if (!(share > 0.0F)) return kSpeedGroups - 1;
    int exponent = 0;
    const float mantissa = std::frexp(std::min(share, 1.0F), &exponent);  // in [0.5, 1)
    const int group = mantissa == 0.5F ? 1 - exponent : -exponent;
    return static_cast<std::size_t>(std::clamp(group, 0, static_cast<int>(kSpeedGroups) - 1));
}

GroupCounts moves_by_group(const GroupCounts& held, double moves) noexcept {
    // Groups that move completely, and the fraction r 2^-j of each other group.
    std::size_t whole = 0;
    double left = std::max(moves, 0.0), rate = 0.0;
    for (; whole < kSpeedGroups; ++whole) {
        double weight = 0.0;
        for (std::size_t j = whole; j < kSpeedGroups; ++j)
            weight += std::ldexp(static_cast<double>(held[j]), -static_cast<int>(j));
        rate = weight > 0.0 ? left / weight : 0.0;
        if (std::ldexp(rate, -static_cast<int>(whole)) <= 1.0) break;
        left -= static_cast<double>(held[whole]);
    }
    GroupCounts counts = held;
    double carried = 0.0;  // remainder of rounding down in earlier groups
    for (std::size_t j = whole; j < kSpeedGroups; ++j) {
        carried += std::ldexp(rate, -static_cast<int>(j)) * static_cast<double>(held[j]);
        counts[j] = std::min(held[j], static_cast<std::size_t>(carried + 1e-9));
        carried -= static_cast<double>(counts[j]);
    }
    return counts;
}

SpeedGroups::SpeedGroups(std::size_t most) : at_(most, Place{0, kSpeedGroups}) {
    for (auto& member : member_) member.reserve(most);
}

GroupCounts SpeedGroups::counts() const noexcept {
    GroupCounts counts{};
    for (std::size_t j = 0; j < kSpeedGroups; ++j) counts[j] = member_[j].size();
    return counts;
}

void SpeedGroups::add(std::uint32_t particle, std::size_t group) noexcept {
    at_[particle] = {static_cast<std::uint32_t>(member_[group].size()), static_cast<std::uint8_t>(group)};
    member_[group].push_back(particle);
}

void SpeedGroups::remove(std::uint32_t particle) noexcept {
    const Place place = at_[particle];
    auto& member = member_[place.group];
    const std::uint32_t last = member.back();
    member[place.slot] = last;
    at_[last].slot = place.slot;
    member.pop_back();
    at_[particle].group = kSpeedGroups;
}

void SpeedGroups::rename(std::uint32_t from, std::uint32_t to) noexcept {
    const Place place = at_[from];
    at_[from].group = kSpeedGroups;
    at_[to] = place;
    member_[place.group][place.slot] = to;
}

std::uint32_t SpeedGroups::next(std::size_t group, std::size_t ahead) const noexcept {
    const auto& member = member_[group];
    return member[(turn_[group] + ahead) % member.size()];
}

void SpeedGroups::advance(std::size_t group) noexcept {
    if (++turn_[group] >= member_[group].size()) turn_[group] = 0;
}

}  // namespace tact
