#include "gui/docking/atom_shapes.hpp"

#include <algorithm>
#include <numeric>
#include <random>

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

Stick stick(const Structure& s, std::size_t i, std::size_t j, float radius_a, AtomPaint paint) {
    return {place_a(s, i), radius_a, place_a(s, j), colours_of(s, i, paint), colours_of(s, j, paint)};
}

}  // namespace

AtomColours colours_of(const Structure& s, std::size_t atom, AtomPaint paint) {
    if (!paint.empty()) return {opaque(paint[atom]), opaque(paint[atom])};
    const Rgba8 chain = opaque(chain_colour(s.chain[atom]));
    return {s.element[atom] == kCarbon ? chain : opaque(element_colour(s.element[atom])), chain};
}

std::vector<Sphere> spheres_of(const Structure& s, AtomPaint paint) {
    std::vector<Sphere> spheres(s.size());
    for (std::size_t i = 0; i < s.size(); ++i)
        spheres[i] = {place_a(s, i), vdw_radius_a(s.element[i]), colours_of(s, i, paint)};
    return spheres;
}

std::vector<Stick> sticks_of(const Structure& s, std::span<const Bond> bonds, AtomPaint paint) {
    std::vector<Stick> sticks;
    std::vector<bool> alone(s.size(), true);
    for (const auto& [i, j] : bonds) {
        sticks.push_back(stick(s, i, j, kStickRadiusA, paint));
        alone[i] = alone[j] = false;
    }
    for (std::size_t i = 0; i < s.size(); ++i)
        if (alone[i]) sticks.push_back(stick(s, i, i, 0.5F * vdw_radius_a(s.element[i]), paint));
    return sticks;
}

std::vector<Stick> trace_of(const Structure& s, std::size_t atoms_per_point, AtomPaint paint) {
    std::vector<Stick> sticks;
    for (const auto& strand : strands_of(s)) {
        const auto points = thinned_strand_a(s, strand, atoms_per_point);
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            const auto atom = [&](std::size_t point) {
                return strand[point * strand.size() / points.size()];
            };
            Stick made = stick(s, atom(k), atom(k + 1), kTraceRadiusA, paint);
            made.from_a = {points[k].x(), points[k].y(), points[k].z()};
            made.to_a = {points[k + 1].x(), points[k + 1].y(), points[k + 1].z()};
            // One colour per chain: the element of a trace atom carries no information.
            made.from.element = made.to.element = made.from.chain;
            sticks.push_back(made);
        }
    }
    return sticks;
}

void order_by_level(std::vector<Sphere>& spheres) {
    std::mt19937 random(1);
    std::shuffle(spheres.begin(), spheres.end(), random);
}

std::size_t order_by_level(std::vector<Stick>& sticks, const Structure& s, std::span<const Bond> bonds) {
    constexpr std::uint32_t kFar = 1U << 30U;
    std::vector<std::vector<std::uint32_t>> bonded(s.size());
    for (const auto& [i, j] : bonds) {
        bonded[i].push_back(j);
        bonded[j].push_back(i);
    }
    std::vector<std::uint32_t> distance(s.size(), kFar), queue;
    for (std::uint32_t i = 0; i < s.size(); ++i)
        if (s.trace[i] != 0) distance[i] = 0, queue.push_back(i);
    for (std::size_t at = 0; at < queue.size(); ++at)
        for (const std::uint32_t next : bonded[queue[at]])
            if (distance[next] == kFar) distance[next] = distance[queue[at]] + 1, queue.push_back(next);
    // Both ends of a backbone bond are at most one bond from a trace atom; so is the first of a side chain.
    const auto rank = [&](std::size_t i) -> std::uint32_t {
        if (i >= bonds.size()) return 0;  // an atom without bonds
        return std::max(distance[bonds[i][0]], distance[bonds[i][1]]);
    };
    std::vector<std::size_t> order(sticks.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    std::vector<Stick> sorted;
    sorted.reserve(sticks.size());
    std::size_t always = 0;
    for (const std::size_t i : order) {
        sorted.push_back(sticks[i]);
        always += rank(i) <= 1 ? 1 : 0;
    }
    sticks = std::move(sorted);
    return always;
}

}  // namespace tact
