#include "gui/drilling/particle_dots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact {
namespace {

constexpr std::uint32_t kGrain = 255;  // levels, as ParticleSettings::grain_levels

bool wet(const Particle& p) { return p.matter != Matter::dust; }

// Hash of its cell: a resting particle does not flicker when others before it are removed.
std::uint8_t shade_of(const std::array<float, 3>& at) {
    const auto cell = [&](std::size_t axis) {  // through a signed number: places beside the bone are negative
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(at[axis]));
    };
    auto bits = cell(0) * 73856093U ^ cell(1) * 19349663U ^ cell(2) * 83492791U;
    bits ^= bits >> 15U;
    bits *= 2246822519U;
    return static_cast<std::uint8_t>(bits >> 24U);
}

// Most grains have one grain's mass, which needs no root.
std::uint8_t size_of(std::uint32_t mass) {
    if (mass <= kGrain) return static_cast<std::uint8_t>(kDotSize);
    return static_cast<std::uint8_t>(
        std::min(kDotSize * std::cbrt(static_cast<float>(mass) / static_cast<float>(kGrain)), 255.0F));
}

}  // namespace

DotRanges build_dots(std::span<const Particle> particles, std::vector<ParticleDot>& dots) {
    dots.resize(particles.size());
    DotRanges ranges;
    ranges.fluids_low.fill(std::numeric_limits<float>::max());
    ranges.fluids_high.fill(std::numeric_limits<float>::lowest());
    // Grains from the front, wet ones from the back: one pass, no second list.
    std::size_t back = dots.size();
    for (const Particle& p : particles) {
        const bool fluid = wet(p);
        ParticleDot& dot = dots[fluid ? --back : ranges.grains++];
        dot = {p.at, p.matter, shade_of(p.at), size_of(p.mass), 0};
        if (!fluid) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            ranges.fluids_low[i] = std::min(ranges.fluids_low[i], p.at[i]);
            ranges.fluids_high[i] = std::max(ranges.fluids_high[i], p.at[i]);
        }
    }
    ranges.fluids = dots.size() - back;
    return ranges;
}

}  // namespace tact
