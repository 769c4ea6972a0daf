#include "prep/modes/elastic_network.hpp"

#include <Spectra/SymEigsShiftSolver.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "ipc/base/error.hpp"
#include "prep/modes/spring_network.hpp"

namespace tact {
namespace {

constexpr double kCutoffM = 15e-10;
constexpr double kShift = 1e-5;  // of the mean stiffness: the matrix that is factorized is positive definite
constexpr double kMassLeast = 1e-3;  // of the mean mass of a node
constexpr double kRigid = 0.5;       // what of a mode must remain without rigid motions
constexpr std::size_t kOthersNearest = 3;

using Sparse = Eigen::SparseMatrix<double>;

struct Nodes {
    std::vector<std::uint32_t> of_atom;
    std::vector<Vec3> at_m;    // centre of mass
    std::vector<double> mass;  // fractions
    std::vector<std::uint16_t> chain;
    std::vector<std::uint32_t> core;  // those of the network

    [[nodiscard]] std::size_t size() const { return at_m.size(); }
};

Nodes nodes_of(const Structure& s) {
    Nodes n;
    n.of_atom = residue_nodes(s);
    const std::size_t count = n.of_atom.empty() ? 0 : std::size_t{n.of_atom.back()} + 1;
    n.at_m.assign(count, Vec3::Zero());
    n.mass.assign(count, 0.0);
    n.chain.assign(count, 0);
    std::vector<bool> backbone(count, false);
    std::vector<Vec3> middle(count, Vec3::Zero());
    std::vector<double> atoms(count, 0.0);
    for (std::size_t i = 0; i < s.size(); ++i) {
        const std::size_t at = n.of_atom[i];
        const auto mass = static_cast<double>(s.mass_fraction[i]);
        const Vec3 p = Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>();
        n.at_m[at] += mass * p;
        n.mass[at] += mass;
        n.chain[at] = s.chain[i];
        middle[at] += p;
        atoms[at] += 1.0;
        if (s.trace[i] != 0) backbone[at] = true;
    }
    for (std::size_t at = 0; at < count; ++at)
        n.at_m[at] = n.mass[at] > 0.0 ? Vec3(n.at_m[at] / n.mass[at]) : Vec3(middle[at] / atoms[at]);
    for (std::uint32_t at = 0; at < count; ++at) {
        if (backbone[at]) n.core.push_back(at);
    }
    if (n.core.size() < kNodesMin) {
        n.core.resize(count);
        std::iota(n.core.begin(), n.core.end(), std::uint32_t{0});
    }
    return n;
}

// Consecutive core nodes of one chain that share a point of the network.
struct Points {
    std::vector<std::vector<std::uint32_t>> members;  // core nodes
    std::vector<Vec3> at_m;
    std::vector<double> mass;
    std::vector<std::uint16_t> chain;
};

Points points_of(const Nodes& nodes) {
    const std::size_t each = (nodes.core.size() + kNodesMax - 1) / kNodesMax;
    Points p;
    for (const std::uint32_t n : nodes.core) {
        const bool joins = !p.members.empty() && p.members.back().size() < each &&
                           nodes.chain[p.members.back().back()] == nodes.chain[n];
        if (!joins) p.members.emplace_back();
        p.members.back().push_back(n);
    }
    const double least = kMassLeast / static_cast<double>(p.members.size());
    for (const auto& members : p.members) {
        Vec3 sum = Vec3::Zero();
        double mass = 0.0;
        for (const std::uint32_t n : members) {
            const double m = std::max(nodes.mass[n], 1e-12);
            sum += m * nodes.at_m[n];
            mass += m;
        }
        p.at_m.push_back(sum / mass);
        p.mass.push_back(std::max(mass, least));
        p.chain.push_back(nodes.chain[members.front()]);
    }
    return p;
}

// M^(-1/2) H M^(-1/2), lower triangle and diagonal.
Sparse weighted_hessian(const Points& points, const std::vector<Spring>& springs) {
    std::vector<Eigen::Matrix3d> diagonal(points.at_m.size(), Eigen::Matrix3d::Zero());
    std::vector<Eigen::Triplet<double>> entries;
    const auto block = [&](std::uint32_t row, std::uint32_t column, const Eigen::Matrix3d& m) {
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                if (row != column || r >= c)
                    entries.emplace_back(3 * static_cast<int>(row) + r, 3 * static_cast<int>(column) + c,
                                         m(r, c));
            }
        }
    };
    for (const Spring& s : springs) {
        const Vec3 along = points.at_m[s.b] - points.at_m[s.a];
        const double length_2 = along.squaredNorm();
        if (!(length_2 > 0.0)) continue;
        const Eigen::Matrix3d k = s.stiffness / length_2 * along * along.transpose();
        diagonal[s.a] += k / points.mass[s.a];
        diagonal[s.b] += k / points.mass[s.b];
        block(s.b, s.a, -k / std::sqrt(points.mass[s.a] * points.mass[s.b]));
    }
    for (std::uint32_t i = 0; i < diagonal.size(); ++i) block(i, i, diagonal[i]);
    const auto size = static_cast<Eigen::Index>(3 * points.at_m.size());
    Sparse h(size, size);
    h.setFromTriplets(entries.begin(), entries.end());
    return h;
}

// (H - shift)^-1 for Spectra.
class Inverse {
public:
    using Scalar = double;
    explicit Inverse(const Sparse& h) : h_(h) {}
    [[nodiscard]] Eigen::Index rows() const { return h_.rows(); }
    [[nodiscard]] Eigen::Index cols() const { return h_.cols(); }
    void set_shift(const double& shift) {
        Sparse shifted = h_;
        for (Eigen::Index i = 0; i < shifted.rows(); ++i) shifted.coeffRef(i, i) -= shift;
        solver_.compute(shifted);
    }
    [[nodiscard]] bool good() const { return solver_.info() == Eigen::Success; }
    void perform_op(const double* x, double* y) const {
        const Eigen::Map<const Eigen::VectorXd> in(x, rows());
        Eigen::Map<Eigen::VectorXd>(y, rows()) = solver_.solve(in);
    }

private:
    const Sparse& h_;
    Eigen::SimplicialLDLT<Sparse> solver_;
};

struct Eigen3 {
    double value = 0.0;
    Eigen::VectorXd motion;  // of the points, not weighted
};

// The softest, rigid motions included, ascending.
std::vector<Eigen3> softest(const Points& points, const std::string& name, std::size_t count) {
    const double scale = std::cbrt(static_cast<double>(points.members.front().size()));
    const Sparse h = weighted_hessian(points, make_springs(points.at_m, points.chain, kCutoffM, scale));
    Inverse inverse(h);
    const auto size = h.rows();
    const auto wanted = static_cast<Eigen::Index>(std::min(count, static_cast<std::size_t>(size - 1)));
    const Eigen::Index basis = std::min<Eigen::Index>(size, std::max<Eigen::Index>(2 * wanted + 10, 40));
    Spectra::SymEigsShiftSolver<Inverse> solver(inverse, wanted, basis,
                                                -kShift * h.diagonal().sum() / static_cast<double>(size));
    if (inverse.good()) {
        solver.init();
        solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-9);
    }
    if (!inverse.good() || solver.info() != Spectra::CompInfo::Successful)
        throw StartupError("computing the normal modes of '" + name + "'", "the eigenvalues did not converge",
                           "check the structure for atoms far from all others, or bake it without modes");
    std::vector<Eigen3> out;
    for (Eigen::Index k = 0; k < wanted; ++k) {
        Eigen3 e{solver.eigenvalues()[k], solver.eigenvectors().col(k)};
        for (std::size_t i = 0; i < points.mass.size(); ++i)
            e.motion.segment<3>(3 * static_cast<Eigen::Index>(i)) /= std::sqrt(points.mass[i]);
        out.push_back(std::move(e));
    }
    std::sort(out.begin(), out.end(), [](const Eigen3& a, const Eigen3& b) { return a.value < b.value; });
    return out;
}

using Field = std::vector<Vec3>;  // displacement of each node

// From the points of the network to all nodes, as weights of at most kOthersNearest points.
std::vector<std::vector<std::pair<std::size_t, double>>> weights_of(const Nodes& nodes,
                                                                    const Points& points) {
    std::vector<std::vector<std::pair<std::size_t, double>>> weights(nodes.size());
    for (std::size_t p = 0; p < points.members.size(); ++p) {
        const auto& members = points.members[p];
        const auto chain_of = [&](std::size_t q) { return nodes.chain[points.members[q].front()]; };
        const double middle = 0.5 * static_cast<double>(members.size() - 1);
        for (std::size_t i = 0; i < members.size(); ++i) {
            // Linear along the chain towards the neighbour on that side.
            const double off = (static_cast<double>(i) - middle) / static_cast<double>(members.size());
            const std::size_t other = off < 0.0 ? p - 1 : p + 1;  // p - 1 of 0 is no point
            const bool has = off != 0.0 && other < points.members.size() && chain_of(other) == chain_of(p);
            weights[members[i]].emplace_back(p, has ? 1.0 - std::abs(off) : 1.0);
            if (has) weights[members[i]].emplace_back(other, std::abs(off));
        }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!weights[n].empty()) continue;
        std::vector<std::pair<double, std::size_t>> near;
        for (std::size_t p = 0; p < points.at_m.size(); ++p)
            near.emplace_back((points.at_m[p] - nodes.at_m[n]).squaredNorm(), p);
        std::partial_sort(near.begin(), near.begin() + kOthersNearest, near.end());
        double sum = 0.0;
        for (std::size_t i = 0; i < kOthersNearest; ++i) {
            const double w = 1.0 / (near[i].first + 1e-20);
            weights[n].emplace_back(near[i].second, w);
            sum += w;
        }
        for (auto& [p, w] : weights[n]) w /= sum;
    }
    return weights;
}

double product(const Nodes& nodes, const Field& a, const Field& b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += nodes.mass[n] * a[n].dot(b[n]);
    return sum;
}

// Takes out what the others, which are orthonormal, explain; returns the fraction that remains, and scales it to 1.
double make_orthonormal(const Nodes& nodes, const std::vector<Field>& others, Field& field) {
    const double before = std::sqrt(product(nodes, field, field));
    for (int twice = 0; twice < 2; ++twice) {
        for (const Field& other : others) {
            const double along = product(nodes, other, field);
            for (std::size_t n = 0; n < nodes.size(); ++n) field[n] -= along * other[n];
        }
    }
    const double after = std::sqrt(product(nodes, field, field));
    if (!(after > 0.0)) return 0.0;
    for (Vec3& v : field) v /= after;
    return after / before;
}

std::vector<Field> rigid_motions(const Nodes& nodes) {
    std::vector<Field> rigid;
    for (int m = 0; m < 6; ++m) {
        const Vec3 axis = Vec3::Unit(m % 3);
        Field field;
        for (const Vec3& p : nodes.at_m) field.push_back(m < 3 ? axis : Vec3(axis.cross(p)));
        // A straight line of nodes does not turn about itself.
        if (make_orthonormal(nodes, rigid, field) > 1e-6) rigid.push_back(std::move(field));
    }
    return rigid;
}

}  // namespace

NormalModes elastic_modes(const Structure& structure, std::uint32_t count, const Progress& progress) {
    report(progress, 0.0, "computing normal modes");
    const Nodes nodes = nodes_of(structure);
    if (nodes.core.size() < kNodesMin) return {};
    const Points points = points_of(nodes);
    const auto weights = weights_of(nodes, points);
    std::vector<Field> known = rigid_motions(nodes);
    const std::size_t rigid = known.size();
    NormalModes modes;
    modes.node = nodes.of_atom;
    double softest_value = 0.0;
    for (const Eigen3& e : softest(points, structure.name, count + 8)) {
        if (modes.count() >= count) break;
        Field field(nodes.size(), Vec3::Zero());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            for (const auto& [p, w] : weights[n])
                field[n] += w * e.motion.segment<3>(3 * static_cast<Eigen::Index>(p));
        }
        if (make_orthonormal(nodes, known, field) < kRigid) continue;
        if (known.size() == rigid) softest_value = std::max(e.value, 1e-300);
        const double stiffness = std::clamp(e.value / softest_value, 1.0, 1e5);
        modes.stiffness.push_back(
            std::max(static_cast<float>(stiffness), modes.stiffness.empty() ? 1.0F : modes.stiffness.back()));
        // The sign of an eigenvector is arbitrary: the largest component is positive.
        double largest = 0.0;
        for (const Vec3& v : field) {
            for (const double c : v) largest = std::abs(c) > std::abs(largest) ? c : largest;
        }
        const double sign = largest < 0.0 ? -1.0 : 1.0;
        for (const Vec3& v : field) {
            modes.x.push_back(static_cast<float>(sign * v.x()));
            modes.y.push_back(static_cast<float>(sign * v.y()));
            modes.z.push_back(static_cast<float>(sign * v.z()));
        }
        known.push_back(std::move(field));
    }
    if (modes.count() == 0)
        throw StartupError("computing the normal modes of '" + structure.name + "'", "no mode was found",
                           "bake it without modes");
    report(progress, 1.0, "computing normal modes");
    return modes;
}

}  // namespace tact
