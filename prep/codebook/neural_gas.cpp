// One level, for N vectors w and atoms v with masses m:
//
// 1. Neural gas. T = presentations_per_vector * N atoms are drawn with probability proportional to mass. For each
//    draw the vectors are ranked by distance, k = 0, 1, …, and moved by  dw = eps(t) exp(-k / lambda(t)) (v - w),  with
//    eps(t) = eps_i (eps_f / eps_i)^(t/T) and lambda alike. Ranks beyond 4 lambda move by less than 2 % of
//    the first and are skipped, so that a draw costs a local search instead of a full sort.
//    Level 0 starts from drawn atoms with a wide lambda. Each further level starts from the previous level and
//    as many additional atoms, drawn where that level is worst, so a narrow lambda suffices.
// 2. The limit lambda -> 0: every vector moves to the centre of mass of the atoms nearest to it, a few times
//    (batch neural gas with rank 0 only). Weights are the masses of these cells, so sum w_i is 1 and sum w_i
//    r_i is the centre of mass. The last step keeps the cells from which the centres were computed, so both sums
//    are exact.
// 3. Competitive Hebbian graph: for every atom once, in random order, an edge joins the nearest and the
//    second nearest vector, with age 0; the other edges of the nearest vector age by one and are removed beyond
//    kAgeMax.
// All in double precision, in units of the structure's radius of gyration; draws by splitmix64.
#include "prep/codebook/neural_gas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/density/vector_grid.hpp"

namespace tact {

namespace {

constexpr double kEpsFirst = 0.5, kEpsLast = 0.005;
constexpr double kLambdaLast = 0.25;
constexpr double kLambdaNarrow = 3.0;  // for levels that start from the previous level
constexpr double kRanksPerLambda = 4.0;
constexpr std::size_t kRanksMax = 64;
constexpr int kCentringSteps = 4;
// Removes edges that recent draws did not confirm. At 27 000 atoms and 25 vectors each vector is drawn a thousand
// times; at 100 vectors and more hardly any edge reaches this age, and the graph follows the atoms alone.
constexpr int kAgeMax = 100;

struct Atoms {
    std::vector<Vec3> at;
    std::vector<double> mass;  // fractions of the total
    std::vector<double> cumulative;
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    double unit_m = 1.0;

    [[nodiscard]] std::size_t draw(SeededRandom& random) const {
        const auto found =
            std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * cumulative.back());
        return std::min(static_cast<std::size_t>(found - cumulative.begin()), at.size() - 1);
    }
};

Atoms make_atoms(const Structure& s) {
    Atoms atoms;
    double inertia = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                     static_cast<double>(s.z_m[i]));
        const auto m = static_cast<double>(s.mass_fraction[i]);
        if (!p.allFinite() || !(m >= 0.0)) {
            throw StartupError(
                "build the codebook of '" + s.name + "'",
                "atom " + std::to_string(i) + " has a position that is not finite or a negative mass",
                "fix the structure");
        }
        atoms.at.push_back(p);
        atoms.mass.push_back(m);
        inertia += m * p.squaredNorm();
    }
    atoms.unit_m = inertia > 0.0 ? std::sqrt(inertia) : 1e-10;
    atoms.low = atoms.high = atoms.at.front() / atoms.unit_m;
    double sum = 0.0;
    for (std::size_t i = 0; i < atoms.at.size(); ++i) {
        atoms.at[i] /= atoms.unit_m;
        atoms.low = atoms.low.cwiseMin(atoms.at[i]);
        atoms.high = atoms.high.cwiseMax(atoms.at[i]);
        atoms.cumulative.push_back(sum += atoms.mass[i]);
    }
    return atoms;
}

std::vector<Vec3> first_vectors(const Atoms& atoms, std::size_t count, SeededRandom& random) {
    std::vector<Vec3> vectors;
    for (std::size_t i = 0; i < count; ++i) vectors.push_back(atoms.at[atoms.draw(random)]);
    return vectors;
}

// The vectors of the previous level and as many atoms, each the worse represented of two drawn atoms.
std::vector<Vec3> more_vectors(const Atoms& atoms, std::vector<Vec3> vectors, std::size_t count,
                               SeededRandom& random) {
    const VectorGrid grid(vectors, atoms.low, atoms.high);
    std::array<VectorGrid::Near, 1> near{};
    const auto miss = [&](std::size_t atom) {
        grid.nearest(atoms.at[atom], near);
        return near[0].distance_2;
    };
    while (vectors.size() < count) {
        const std::size_t a = atoms.draw(random), b = atoms.draw(random);
        vectors.push_back(atoms.at[miss(a) > miss(b) ? a : b]);
    }
    return vectors;
}

void adapt(const Atoms& atoms, VectorGrid& grid, double lambda_first, std::size_t draws,
           SeededRandom& random) {
    std::array<VectorGrid::Near, kRanksMax> near{};
    for (std::size_t t = 0; t < draws; ++t) {
        const double s = static_cast<double>(t) / static_cast<double>(draws);
        const double eps = kEpsFirst * std::pow(kEpsLast / kEpsFirst, s);
        const double lambda = lambda_first * std::pow(kLambdaLast / lambda_first, s);
        const auto ranks = std::min(kRanksMax, static_cast<std::size_t>(std::ceil(kRanksPerLambda * lambda)));
        const Vec3& v = atoms.at[atoms.draw(random)];
        const std::size_t found = grid.nearest(v, {near.data(), ranks});
        const double fall = std::exp(-1.0 / lambda);
        double share = eps;
        for (std::size_t k = 0; k < found; ++k, share *= fall) {
            const Vec3& w = grid[near[k].index];
            grid.move(near[k].index, w + share * (v - w));
        }
    }
}

struct Cells {
    std::vector<Vec3> centre;
    std::vector<double> mass;
    double error_2 = 0.0;  // mean square distance of the atoms from the centre of their cell
};

// Cells of the atoms nearest to each vector, and their centres of mass. A vector without atoms moves to the worst
// represented atom of another cell and takes that atom.
Cells centre(const Atoms& atoms, const VectorGrid& grid) {
    const std::size_t n = grid.size();
    std::vector<std::uint32_t> owner(atoms.at.size());
    std::vector<double> miss(atoms.at.size());
    std::vector<std::uint32_t> atoms_in(n, 0);
    std::array<VectorGrid::Near, 1> near{};
    for (std::size_t i = 0; i < atoms.at.size(); ++i) {
        grid.nearest(atoms.at[i], near);
        owner[i] = near[0].index;
        miss[i] = near[0].distance_2 * atoms.mass[i];
        ++atoms_in[owner[i]];
    }
    std::vector<std::size_t> worst;
    for (std::uint32_t j = 0; j < n; ++j) {
        if (atoms_in[j] != 0) continue;
        if (worst.empty()) {
            worst.resize(atoms.at.size());
            std::iota(worst.begin(), worst.end(), std::size_t{0});
            std::stable_sort(worst.begin(), worst.end(), [&](auto a, auto b) { return miss[a] < miss[b]; });
        }
        while (atoms_in[owner[worst.back()]] < 2)
            worst.pop_back();  // terminates: there are more atoms than vectors
        --atoms_in[owner[worst.back()]];
        owner[worst.back()] = j;
        atoms_in[j] = 1;
        worst.pop_back();
    }
    Cells cells{std::vector<Vec3>(n, Vec3::Zero()), std::vector<double>(n, 0.0), 0.0};
    std::vector<Vec3> plain(n, Vec3::Zero());
    for (std::size_t i = 0; i < atoms.at.size(); ++i) {
        cells.centre[owner[i]] += atoms.mass[i] * atoms.at[i];
        cells.mass[owner[i]] += atoms.mass[i];
        plain[owner[i]] += atoms.at[i];
    }
    for (std::size_t j = 0; j < n; ++j) {  // all atoms of a cell may have mass 0
        cells.centre[j] = cells.mass[j] > 0.0 ? Vec3(cells.centre[j] / cells.mass[j])
                                              : Vec3(plain[j] / static_cast<double>(atoms_in[j]));
    }
    for (std::size_t i = 0; i < atoms.at.size(); ++i) {
        cells.error_2 += atoms.mass[i] * (atoms.at[i] - cells.centre[owner[i]]).squaredNorm();
    }
    return cells;
}

std::vector<std::array<std::uint32_t, 2>> hebbian_graph(const Atoms& atoms, const VectorGrid& grid,
                                                        SeededRandom& random) {
    std::vector<std::size_t> order(atoms.at.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    std::vector<std::map<std::uint32_t, int>> age(
        grid.size());  // ages of the edges of each vector, stored at both ends
    std::array<VectorGrid::Near, 2> near{};
    for (const std::size_t i : order) {
        if (grid.nearest(atoms.at[i], near) < 2) continue;
        const std::uint32_t first = near[0].index, second = near[1].index;
        std::map<std::uint32_t, int>& edges = age[first];
        for (auto edge = edges.begin(); edge != edges.end();) {
            const int years = ++edge->second;
            age[edge->first][first] = years;
            if (years > kAgeMax) {
                age[edge->first].erase(first);
                edge = edges.erase(edge);
            } else {
                ++edge;
            }
        }
        edges[second] = 0;
        age[second][first] = 0;
    }
    std::vector<std::array<std::uint32_t, 2>> graph;
    for (std::uint32_t a = 0; a < age.size(); ++a) {
        for (const auto& [b, years] : age[a]) {
            if (a < b) graph.push_back({a, b});
        }
    }
    return graph;
}

Codebook::Level make_level(const Atoms& atoms, const Cells& cells, const VectorGrid& grid,
                           SeededRandom& random) {
    Codebook::Level level;
    const double total = std::accumulate(cells.mass.begin(), cells.mass.end(), 0.0);
    for (std::size_t j = 0; j < cells.centre.size(); ++j) {
        const Vec3 p = cells.centre[j] * atoms.unit_m;
        level.x_m.push_back(static_cast<float>(p.x()));
        level.y_m.push_back(static_cast<float>(p.y()));
        level.z_m.push_back(static_cast<float>(p.z()));
        level.weight.push_back(static_cast<float>(cells.mass[j] / total));
    }
    level.edges = hebbian_graph(atoms, grid, random);
    level.rms_error_m = std::sqrt(cells.error_2 / total) * atoms.unit_m;
    return level;
}

}  // namespace

Codebook build_codebook(const Structure& structure, const CodebookSettings& settings,
                        const Progress& progress) {
    Codebook codebook;
    if (structure.size() < 2 * std::size_t{settings.smallest} || settings.smallest == 0) return codebook;
    const Atoms atoms = make_atoms(structure);
    if (!(atoms.cumulative.back() > 0.0)) return codebook;
    SeededRandom random(settings.seed);
    double all = 0.0, done = 0.0;
    for (std::size_t n = settings.smallest; 2 * n <= atoms.at.size(); n *= 2) all += static_cast<double>(n);
    std::vector<Vec3> vectors;
    for (std::size_t n = settings.smallest; 2 * n <= atoms.at.size(); n *= 2) {
        report(progress, done / all, "codebook");
        const bool first = vectors.empty();
        vectors =
            first ? first_vectors(atoms, n, random) : more_vectors(atoms, std::move(vectors), n, random);
        VectorGrid grid(vectors, atoms.low, atoms.high);
        const double lambda = first ? static_cast<double>(n) / 2.0 : kLambdaNarrow;
        // Level 0 is small and starts unordered; ten times the draws cost little.
        adapt(atoms, grid, lambda, n * settings.presentations_per_vector * (first ? 10 : 1), random);
        Cells cells;
        for (int i = 0; i < kCentringSteps; ++i) {
            cells = centre(atoms, grid);
            for (std::uint32_t j = 0; j < n; ++j) grid.move(j, cells.centre[j]);
        }
        codebook.levels.push_back(make_level(atoms, cells, grid, random));
        vectors = cells.centre;
        done += static_cast<double>(n);
    }
    report(progress, 1.0, "codebook");
    return codebook;
}

}  // namespace tact
