#include "gui/docking/atom_shapes.hpp"

#include "gui/render/elements.hpp"
#include "gui/render/tube.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

constexpr std::uint8_t kCarbon = 6;

std::array<float, 3> place_a(const Structure& s, std::size_t i) {
    constexpr auto kM = static_cast<float>(1.0 / kAngstromM);
    return {kM * s.x_m[i], kM * s.y_m[i], kM * s.z_m[i]};
}

Rgba8 opaque(const Rgb8& c) { return {c[0], c[1], c[2], 255}; }

Stick stick(const Structure& s, std::size_t i, std::size_t j, float radius_a) {
    return {place_a(s, i), radius_a, place_a(s, j), colours_of(s, i), colours_of(s, j)};
}

}  // namespace

AtomColours colours_of(const Structure& s, std::size_t atom) {
    const Rgba8 chain = opaque(chain_colour(s.chain[atom]));
    return {s.element[atom] == kCarbon ? chain : opaque(element_colour(s.element[atom])), chain};
}

std::vector<Sphere> spheres_of(const Structure& s) {
    std::vector<Sphere> spheres(s.size());
    for (std::size_t i = 0; i < s.size(); ++i)
        spheres[i] = {place_a(s, i), vdw_radius_a(s.element[i]), colours_of(s, i)};
    return spheres;
}

std::vector<Stick> sticks_of(const Structure& s, std::span<const Bond> bonds) {
    std::vector<Stick> sticks;
    std::vector<bool> alone(s.size(), true);
    for (const auto& [i, j] : bonds) {
        sticks.push_back(stick(s, i, j, kStickRadiusA));
        alone[i] = alone[j] = false;
    }
    for (std::size_t i = 0; i < s.size(); ++i)
        if (alone[i]) sticks.push_back(stick(s, i, i, 0.5F * vdw_radius_a(s.element[i])));
    return sticks;
}

std::vector<Stick> trace_of(const Structure& s) {
    std::vector<Stick> sticks;
    for (const auto& strand : strands_of(s))
        for (std::size_t k = 0; k + 1 < strand.size(); ++k) {
            sticks.push_back(stick(s, strand[k], strand[k + 1], kTraceRadiusA));
            // One colour per chain: the element of a trace atom carries no information.
            sticks.back().from.element = sticks.back().to.element = sticks.back().from.chain;
        }
    return sticks;
}

}  // namespace tact
