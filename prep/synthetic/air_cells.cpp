// Method. The walls are the planes midway between a point's own site and the sites near it (a Voronoi foam). The two
// nearest planes are blended smoothly, as the corners of real cells are round. Every fourth wall has a window around
// the line between the two sites.
#include "prep/synthetic/air_cells.hpp"

#include <array>
#include <cmath>

#include "prep/synthetic/shapes.hpp"

namespace tact {
namespace {

std::uint64_t lattice_bits(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) noexcept {
    std::uint64_t z = seed * 0xD1342543DE82EF95ULL + static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL +
                      static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL +
                      static_cast<std::uint64_t>(k) * 0x165667B19E3779F9ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

constexpr double kRoundness = 0.16, kWindow = 0.2;

}  // namespace

double lattice_random(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) noexcept {
    return static_cast<double>(lattice_bits(seed, i, j, k) >> 11) * 0x1p-53;
}

double lattice_noise(std::uint64_t seed, const Vec3& p) noexcept {
    std::array<std::int64_t, 3> cell;
    Vec3 s;
    for (int a = 0; a < 3; ++a) {
        const double low = std::floor(p[a]), t = p[a] - low;
        cell[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(low);
        s[a] = t * t * (3.0 - 2.0 * t);
    }
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
        sum += (x != 0 ? s.x() : 1.0 - s.x()) * (y != 0 ? s.y() : 1.0 - s.y()) *
               (z != 0 ? s.z() : 1.0 - s.z()) * lattice_random(seed, cell[0] + x, cell[1] + y, cell[2] + z);
    }
    return 2.0 * sum - 1.0;
}

double cell_wall_distance(std::uint64_t seed, const Vec3& p) noexcept {
    struct Site {
        Vec3 at;
        std::uint64_t bits;
        double squared;
    };
    std::array<Site, 27> site;
    std::size_t own = 0, n = 0;
    const auto x = static_cast<std::int64_t>(std::floor(p.x()));
    const auto y = static_cast<std::int64_t>(std::floor(p.y()));
    const auto z = static_cast<std::int64_t>(std::floor(p.z()));
    for (std::int64_t k = z - 1; k <= z + 1; ++k) {
        for (std::int64_t j = y - 1; j <= y + 1; ++j) {
            for (std::int64_t i = x - 1; i <= x + 1; ++i, ++n) {
                const std::uint64_t bits = lattice_bits(seed, i, j, k);
                const auto part = [&](unsigned shift) {  // within 0.1 to 0.9, so that sites keep a distance
                    return 0.1 + 0.8 * static_cast<double>(bits >> shift & 0xFFFFU) / 65536.0;
                };
                site[n].at = Vec3(static_cast<double>(i) + part(0), static_cast<double>(j) + part(16),
                                  static_cast<double>(k) + part(32));
                site[n].bits = bits;
                site[n].squared = (p - site[n].at).squaredNorm();
                if (site[n].squared < site[own].squared) own = n;
            }
        }
    }
    double first = 2.0, second = 2.0;
    for (std::size_t i = 0; i < n; ++i) {
        if (i == own) continue;
        const Vec3 between = site[i].at - site[own].at;
        const double length2 = between.squaredNorm();
        const double gap = site[i].squared - site[own].squared;
        if (gap * gap > 4.0 * length2 * second * second) continue;  // farther than the second nearest
        const double length = std::sqrt(length2);
        double d = 0.5 * gap / length;
        if (((site[i].bits ^ site[own].bits) >> 50 & 3U) == 0) {  // symmetric in the two sites
            const Vec3 from_middle = p - 0.5 * (site[i].at + site[own].at);
            const double along = from_middle.dot(between) / length;
            const double across = std::sqrt(std::max(from_middle.squaredNorm() - along * along, 0.0));
            d = std::max(d, kWindow - across);
        }
        if (d < first) {
            second = first;
            first = d;
        } else if (d < second) {
            second = d;
        }
    }
    return shape::join(first, second, kRoundness);
}

}  // namespace tact
