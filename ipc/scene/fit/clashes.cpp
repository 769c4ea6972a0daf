// Each structure's atoms are sorted into cells, in its own frame; a cell is as wide as the largest clash
// distance, so 27 cells contain all partners of an atom. Cells are sorted numbers, not a table over the
// box: memory is proportional to the atoms. For two structures, the smaller one's atoms search the other's
// cells.
#include "ipc/scene/fit/clashes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact {

namespace {

struct Radius {
    std::uint8_t element;
    double angstrom;
};
// Bondi, J. Phys. Chem. 68:441 (1964), table I and V.
constexpr std::array kRadii{Radius{1, 1.20},  Radius{2, 1.40},  Radius{3, 1.82},  Radius{6, 1.70},
                            Radius{7, 1.55},  Radius{8, 1.52},  Radius{9, 1.47},  Radius{10, 1.54},
                            Radius{11, 2.27}, Radius{12, 1.73}, Radius{14, 2.10}, Radius{15, 1.80},
                            Radius{16, 1.80}, Radius{17, 1.75}, Radius{18, 1.88}, Radius{19, 2.75},
                            Radius{28, 1.63}, Radius{29, 1.40}, Radius{30, 1.39}, Radius{34, 1.90},
                            Radius{35, 1.85}, Radius{53, 1.98}};
constexpr double kOtherA = 1.70, kLargestA = 2.75;
constexpr double kCellM = (2.0 * kLargestA) * 1e-10 - kClashOverlapM;
constexpr double kFarthestM = 1e-3;  // beyond, cell numbers could overflow; no structure is that far away

bool shares_hydrogen(std::uint8_t element) { return element == 7 || element == 8 || element == 16; }

std::uint8_t element_of(const Structure& s, std::size_t i) { return i < s.element.size() ? s.element[i] : 0; }

Vec3 atom(const Structure& s, std::size_t i) {
    return {static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]), static_cast<double>(s.z_m[i])};
}

std::uint64_t cell_number(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1FFFFFU; };
    return (part(x) << 42U) | (part(y) << 21U) | part(z);
}

std::array<std::int64_t, 3> cell_of(const Vec3& p_m) {
    std::array<std::int64_t, 3> c{};
    for (std::size_t a = 0; a < 3; ++a) {
        c[a] = static_cast<std::int64_t>(std::floor(p_m[static_cast<Eigen::Index>(a)] / kCellM));
    }
    return c;
}

bool placeable(const Vec3& p_m) { return p_m.allFinite() && p_m.cwiseAbs().maxCoeff() < kFarthestM; }

struct Cells {
    struct Entry {
        std::uint64_t cell;
        std::uint32_t atom;
    };
    std::vector<Entry> entries;  // sorted by cell
    double radius_m = 0.0;       // of the structure about its origin

    explicit Cells(const Structure& s) {
        entries.reserve(s.size());
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec3 p = atom(s, i);
            if (!placeable(p)) continue;
            const auto c = cell_of(p);
            entries.push_back({cell_number(c[0], c[1], c[2]), static_cast<std::uint32_t>(i)});
            radius_m = std::max(radius_m, p.norm());
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return a.cell < b.cell || (a.cell == b.cell && a.atom < b.atom);
        });
    }

    template <class Visit>
    void near(const Vec3& p_m, Visit&& visit) const {
        const auto c = cell_of(p_m);
        for (std::int64_t x = c[0] - 1; x <= c[0] + 1; ++x) {
            for (std::int64_t y = c[1] - 1; y <= c[1] + 1; ++y) {
                // Three cells along z are adjacent in the order.
                const std::uint64_t first = cell_number(x, y, c[2] - 1), last = cell_number(x, y, c[2] + 1);
                auto at = std::lower_bound(entries.begin(), entries.end(), first,
                                           [](const Entry& e, std::uint64_t cell) { return e.cell < cell; });
                for (; at != entries.end() && at->cell <= last; ++at) visit(at->atom);
            }
        }
    }
};

}  // namespace

double van_der_waals_radius_m(std::uint8_t element) {
    for (const Radius& r : kRadii) {
        if (r.element == element) return r.angstrom * 1e-10;
    }
    return kOtherA * 1e-10;
}

ClashCounts count_clashes(std::span<const PlacedStructure> placed) {
    ClashCounts counts;
    counts.pairs_of.resize(placed.size());
    counts.atoms_of.resize(placed.size());
    std::vector<Cells> cells;
    std::vector<std::vector<bool>> clashing;
    for (const PlacedStructure& p : placed) {
        cells.emplace_back(*p.structure);
        clashing.emplace_back(p.structure->size(), false);
    }
    for (std::size_t one = 0; one < placed.size(); ++one) {
        for (std::size_t two = one + 1; two < placed.size(); ++two) {
            const bool swapped = placed[one].structure->size() > placed[two].structure->size();
            const std::size_t a = swapped ? two : one,
                              b = swapped ? one : two;  // a's atoms search b's cells
            const Structure &sa = *placed[a].structure, &sb = *placed[b].structure;
            const Pose T_b_a = placed[b].T_model_body.inverse() * placed[a].T_model_body;
            if (!T_b_a.finite() || T_b_a.p_m.norm() > cells[a].radius_m + cells[b].radius_m + kCellM)
                continue;
            std::uint64_t pairs = 0;
            for (std::size_t i = 0; i < sa.size(); ++i) {
                const Vec3 p = T_b_a * atom(sa, i);
                if (!placeable(p) || p.norm() > cells[b].radius_m + kCellM) continue;
                const std::uint8_t ei = element_of(sa, i);
                cells[b].near(p, [&](std::uint32_t j) {
                    const std::uint8_t ej = element_of(sb, j);
                    const double share = shares_hydrogen(ei) && shares_hydrogen(ej) ? kClashShareM : 0.0;
                    const double reach =
                        van_der_waals_radius_m(ei) + van_der_waals_radius_m(ej) - share - kClashOverlapM;
                    if ((atom(sb, j) - p).squaredNorm() > reach * reach) return;
                    ++pairs;
                    clashing[a][i] = true;
                    clashing[b][j] = true;
                });
            }
            counts.pairs += pairs;
            counts.pairs_of[a] += pairs;
            counts.pairs_of[b] += pairs;
        }
    }
    for (std::size_t k = 0; k < placed.size(); ++k) {
        counts.atoms_of[k] =
            static_cast<std::uint32_t>(std::count(clashing[k].begin(), clashing[k].end(), true));
    }
    return counts;
}

}  // namespace tact
