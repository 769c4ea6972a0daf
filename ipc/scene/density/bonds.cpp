#include "ipc/scene/density/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "ipc/base/units.hpp"

namespace tact {
namespace {

// Picometres. Manganese, iron and cobalt: high spin.
constexpr std::uint8_t kCovalentPm[] = {
    76,  31,  0,   0,   0,   84,  76,  71,  66,  57,  0,   0,   0,   121, 111, 107, 105, 102, 0,
    0,   0,   170, 160, 153, 139, 161, 152, 150, 124, 132, 122, 122, 120, 119, 120, 120, 0,   0,
    0,   190, 175, 164, 154, 147, 146, 142, 139, 145, 144, 142, 139, 139, 138, 139, 0,   0,   0,
    207, 204, 203, 201, 199, 198, 198, 196, 194, 192, 192, 189, 190, 187, 187, 175, 170, 162, 151,
    144, 141, 136, 136, 132, 145, 146, 148, 140, 150, 0,   0,   0,   215, 206, 200, 196};

constexpr std::uint8_t kSulphur = 16;
// Above the longest possible bond, so that a bond reaches the next cell at most.
constexpr double kCellA = 4.8;
constexpr std::int64_t kPlaceMax = std::int64_t{1} << 20;

// Sorted by cell, so that the atoms of a cell are contiguous.
struct Celled {
    std::uint64_t cell;
    std::uint32_t atom;
    friend bool operator<(const Celled& a, const Celled& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.atom < b.atom;
    }
};

using Place = std::array<std::int64_t, 3>;

// Structures extend 1e-3 m at most (read_structure), two million cells to either side. Cells are clamped; atoms
// beyond the clamp are only compared more often.
Place place_of(const Structure& s, std::size_t i) {
    Place p{};
    const std::array<float, 3> at{s.x_m[i], s.y_m[i], s.z_m[i]};
    for (std::size_t k = 0; k < 3; ++k) {
        const double cell = std::floor(static_cast<double>(at[k]) / (kCellA * kAngstromM));
        p[k] = static_cast<std::int64_t>(
            std::clamp(cell, -static_cast<double>(kPlaceMax) + 2, static_cast<double>(kPlaceMax) - 2));
    }
    return p;
}

std::uint64_t key_of(const Place& p) {
    std::uint64_t key = 0;
    for (std::size_t k = 3; k-- > 0;) key = key << 21U | static_cast<std::uint64_t>(p[k] + kPlaceMax);
    return key;
}

}  // namespace

float covalent_radius_a(std::uint8_t atomic_number) {
    return atomic_number < std::size(kCovalentPm) ? 0.01F * static_cast<float>(kCovalentPm[atomic_number])
                                                  : 0.0F;
}

bool bonded(const Structure& s, std::uint32_t i, std::uint32_t j) {
    const double ri = static_cast<double>(covalent_radius_a(s.element[i]));
    const double rj = static_cast<double>(covalent_radius_a(s.element[j]));
    if (!(ri > 0.0) || !(rj > 0.0)) return false;
    const bool near_in_chain =
        s.chain[i] == s.chain[j] && std::llabs(std::int64_t{s.residue[i]} - std::int64_t{s.residue[j]}) <= 1;
    const bool bridge = s.element[i] == kSulphur && s.element[j] == kSulphur;
    if (!near_in_chain && !bridge) return false;
    const double dx = static_cast<double>(s.x_m[i]) - static_cast<double>(s.x_m[j]);
    const double dy = static_cast<double>(s.y_m[i]) - static_cast<double>(s.y_m[j]);
    const double dz = static_cast<double>(s.z_m[i]) - static_cast<double>(s.z_m[j]);
    const double a = std::sqrt(dx * dx + dy * dy + dz * dz) / kAngstromM;
    return a > kBondMinA && a < ri + rj + kBondSlackA;
}

std::vector<Bond> find_bonds(const Structure& s) {
    std::vector<Celled> list(s.size());
    for (std::size_t i = 0; i < s.size(); ++i)
        list[i] = {key_of(place_of(s, i)), static_cast<std::uint32_t>(i)};
    std::sort(list.begin(), list.end());
    std::vector<Bond> bonds;
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        const Place centre = place_of(s, i);
        std::size_t of_atom = 0;
        for (int n = 0; n < 9; ++n) {  // rows of three cells along x, the lowest part of a key
            const Place first{centre[0] - 1, centre[1] + n % 3 - 1, centre[2] + n / 3 - 1};
            const std::uint64_t last = key_of({centre[0] + 1, first[1], first[2]});
            auto at = std::lower_bound(list.begin(), list.end(), Celled{key_of(first), 0});
            for (std::size_t k = 0; k < kRowAtomsMax && at != list.end() && at->cell <= last; ++k, ++at) {
                if (at->atom <= i || of_atom >= kBondsOfAtomMax || !bonded(s, i, at->atom)) continue;
                bonds.push_back({i, at->atom});
                ++of_atom;
            }
        }
    }
    std::sort(bonds.begin(), bonds.end());
    return bonds;
}

}  // namespace tact
