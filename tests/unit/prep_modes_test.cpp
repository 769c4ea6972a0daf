// Normal modes: against a dense solution of a network built here pair by pair, and against what a hinge must do.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "prep/modes/bake_modes.hpp"
#include "prep/modes/elastic_network.hpp"
#include "prep/synthetic/ring.hpp"

namespace tact::prep_modes_test {
namespace {

constexpr double kA = 1e-10;

// Residues of one atom each, every atom a backbone atom.
Structure of_points(const std::vector<Vec3>& at, const std::vector<std::uint16_t>& chain) {
    Structure s;
    s.name = "points";
    Vec3 com = Vec3::Zero();
    double total = 0.0;
    const auto mass = [](std::size_t i) { return 1.0 + 0.1 * static_cast<double>(i % 5); };
    for (std::size_t i = 0; i < at.size(); ++i) com += mass(i) * at[i], total += mass(i);
    com /= total;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Eigen::Vector3f p = (at[i] - com).cast<float>();
        s.x_m.push_back(p.x());
        s.y_m.push_back(p.y());
        s.z_m.push_back(p.z());
        s.mass_fraction.push_back(static_cast<float>(mass(i) / total));
        s.element.push_back(6);
        s.chain.push_back(chain[i]);
        s.residue.push_back(static_cast<std::int32_t>(i));
        s.trace.push_back(1);
    }
    s.mass_u = total;
    s.chain_names = {"A", "B"};
    return s;
}

// A walk of steps of 3.8 A inside a ball.
std::vector<Vec3> blob(std::size_t count, const Vec3& centre, double radius_m, std::uint64_t seed) {
    SeededRandom random(seed);
    std::vector<Vec3> at{centre};
    while (at.size() < count) {
        const Vec3 p = at.back() + 3.8 * kA * random.direction();
        if ((p - centre).norm() < radius_m) at.push_back(p);
    }
    return at;
}

Vec3 atom(const Structure& s, std::size_t i) {
    return Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>();
}

Vec3 shift(const NormalModes& m, std::size_t mode, std::size_t node) {
    std::array<float, kModesMax> a{};
    a[mode] = 1.0F;
    return m.shift_m(node, a);
}

double weighted(const Structure& s, const NormalModes& m, std::size_t j, std::size_t k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i)
        sum += static_cast<double>(s.mass_fraction[i]) * shift(m, j, m.node[i]).dot(shift(m, k, m.node[i]));
    return sum;
}

void expect_orthonormal(const Structure& s, const NormalModes& m) {
    for (std::size_t j = 0; j < m.count(); ++j) {
        for (std::size_t k = 0; k <= j; ++k) EXPECT_NEAR(weighted(s, m, j, k), j == k ? 1.0 : 0.0, 1e-4);
        Vec3 moved = Vec3::Zero(), turned = Vec3::Zero();
        for (std::size_t i = 0; i < s.size(); ++i) {
            const auto w = static_cast<double>(s.mass_fraction[i]);
            moved += w * shift(m, j, m.node[i]);
            turned += w * atom(s, i).cross(shift(m, j, m.node[i])) / radius_of_gyration_m(s);
        }
        EXPECT_LT(moved.norm(), 1e-4);
        EXPECT_LT(turned.norm(), 0.05);  // residues move as their centres, atoms are beside them
    }
}

TEST(NormalModes, those_of_a_compact_chain_are_the_softest_of_the_dense_problem) {
    const std::vector<Vec3> at = blob(60, Vec3::Zero(), 11.0 * kA, 3);
    const Structure s = of_points(at, std::vector<std::uint16_t>(60, 0));
    const NormalModes m = elastic_modes(s, 10);
    ASSERT_EQ(m.count(), 10U);
    expect_orthonormal(s, m);
    // The same network, dense: every pair within 15 A, and the chain. Nodes are so close that all have many springs.
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(180, 180);
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < i; ++j) {
            const Vec3 d = atom(s, static_cast<std::size_t>(i)) - atom(s, static_cast<std::size_t>(j));
            if (d.norm() > 15.0 * kA) continue;  // all of the chain are nearer
            const double chain = i - j == 1 ? 200.0 : i - j == 2 ? 60.0 : i - j == 3 ? 20.0 : 0.0;
            const double k = std::max(chain, std::pow(7.0 * kA / std::max(d.norm(), kA), 6.0));
            const Eigen::Matrix3d b = k * d.normalized() * d.normalized().transpose();
            h.block<3, 3>(3 * i, 3 * i) += b;
            h.block<3, 3>(3 * j, 3 * j) += b;
            h.block<3, 3>(3 * i, 3 * j) -= b;
            h.block<3, 3>(3 * j, 3 * i) -= b;
        }
    }
    Eigen::VectorXd root(180);
    for (int i = 0; i < 180; ++i)
        root[i] = std::sqrt(static_cast<double>(s.mass_fraction[static_cast<std::size_t>(i / 3)]));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(root.cwiseInverse().asDiagonal() * h *
                                                               root.cwiseInverse().asDiagonal());
    EXPECT_LT(dense.eigenvalues()[5], 1e-6 * dense.eigenvalues()[6]);
    for (int k = 0; k < 10; ++k) {
        EXPECT_NEAR(static_cast<double>(m.stiffness[static_cast<std::size_t>(k)]),
                    dense.eigenvalues()[6 + k] / dense.eigenvalues()[6],
                    1e-3 * dense.eigenvalues()[6 + k] / dense.eigenvalues()[6]);
        Eigen::VectorXd mine(180);
        for (int n = 0; n < 60; ++n)
            mine.segment<3>(3 * n) = shift(m, static_cast<std::size_t>(k), static_cast<std::size_t>(n));
        const double along = (root.asDiagonal() * mine).dot(dense.eigenvectors().col(6 + k));
        EXPECT_NEAR(std::abs(along), 1.0, 1e-3) << "mode " << k;
    }
}

TEST(NormalModes, the_softest_of_two_lobes_turns_each_as_a_whole) {
    std::vector<Vec3> at = blob(80, Vec3(-16.0, 0.0, 0.0) * kA, 11.0 * kA, 5);
    for (double x = -4.0; x <= 4.0; x += 3.8) at.emplace_back(x * kA, 0.0, 0.0);
    const std::size_t second = at.size();
    for (const Vec3& p : blob(80, Vec3(16.0, 0.0, 0.0) * kA, 11.0 * kA, 6)) at.push_back(p);
    const Structure s = of_points(at, std::vector<std::uint16_t>(at.size(), 0));
    const NormalModes m = elastic_modes(s, 3);
    ASSERT_EQ(m.count(), 3U);
    // What a rigid motion of each lobe leaves of the displacements, by least squares.
    for (const auto& [begin, end] : {std::pair<std::size_t, std::size_t>(0, 80), {second, at.size()}}) {
        Eigen::MatrixXd rigid(3 * (end - begin), 6);
        Eigen::VectorXd u(3 * (end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            const auto row = static_cast<Eigen::Index>(3 * (i - begin));
            const Vec3 p = atom(s, i) / kA;
            rigid.block<3, 3>(row, 0).setIdentity();
            rigid.block<3, 3>(row, 3) << 0.0, p.z(), -p.y(), -p.z(), 0.0, p.x(), p.y(), -p.x(), 0.0;
            u.segment<3>(row) = shift(m, 0, i);
        }
        const Eigen::VectorXd best = rigid.colPivHouseholderQr().solve(u);
        EXPECT_LT((u - rigid * best).norm(), 0.2 * u.norm());
    }
}

TEST(NormalModes, chains_far_apart_hold_together) {
    std::vector<Vec3> at = blob(40, Vec3::Zero(), 10.0 * kA, 7);
    for (const Vec3& p : blob(40, Vec3(60.0, 0.0, 0.0) * kA, 10.0 * kA, 8)) at.push_back(p);
    std::vector<std::uint16_t> chain(80, 0);
    std::fill(chain.begin() + 40, chain.end(), std::uint16_t{1});
    const Structure s = of_points(at, chain);
    const NormalModes m = elastic_modes(s, 12);
    EXPECT_EQ(m.count(), 12U);
    expect_orthonormal(s, m);
    EXPECT_LT(m.stiffness.back(), 5e4F);  // 1e5 would be a part that moves freely
}

TEST(NormalModes, the_same_structure_has_the_same_modes) {
    const Structure s = make_ring().subunits.front();
    const NormalModes a = elastic_modes(s, 12), b = elastic_modes(s, 12);
    expect_orthonormal(s, a);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.stiffness, b.stiffness);
}

TEST(NormalModes, a_structure_of_few_residues_has_none) {
    const Structure s = of_points(blob(15, Vec3::Zero(), 10.0 * kA, 7), std::vector<std::uint16_t>(15, 0));
    EXPECT_EQ(elastic_modes(s, 12).count(), 0U);
}

// Scene with a ring's subunit, and a small structure without modes after it.
class ModeSection : public testing::Test {
protected:
    [[nodiscard]] NormalModes read_back(const NormalModes& modes) const {
        SceneWriter out;
        write_modes(out, 0, modes);
        const std::vector<std::byte> bytes = out.to_bytes();
        return read_modes(SceneFile::from_bytes(bytes, "test"), 0, structure_);
    }
    Structure structure_ = make_ring().subunits.front();
    NormalModes modes_ = elastic_modes(structure_, 4);
};

TEST_F(ModeSection, is_read_as_written) {
    const NormalModes back = read_back(modes_);
    EXPECT_EQ(back.node, modes_.node);
    EXPECT_EQ(back.stiffness, modes_.stiffness);
    EXPECT_EQ(back.x, modes_.x);
    EXPECT_EQ(back.z, modes_.z);
    EXPECT_EQ(read_back({}).count(), 0U);
    SceneWriter without;
    write_structure(without, 0, structure_);
    const std::vector<std::byte> bytes = without.to_bytes();
    EXPECT_EQ(read_modes(SceneFile::from_bytes(bytes, "test"), 0, structure_).count(), 0U);
}

TEST_F(ModeSection, what_cannot_be_a_mode_is_refused) {
    const auto refused = [&](auto&& damage) {
        NormalModes damaged = modes_;
        damage(damaged);
        EXPECT_THROW(static_cast<void>(read_back(damaged)), StartupError);
    };
    refused([](NormalModes& m) { m.x[5] = std::nanf(""); });
    refused([](NormalModes& m) { m.x[5] += 100.0F; });
    refused([](NormalModes& m) { m.node[3] = 5; });
    refused([](NormalModes& m) { m.node.pop_back(); });
    refused([](NormalModes& m) { m.stiffness[0] = 2.0F; });
    refused([](NormalModes& m) { m.stiffness[2] = 0.5F; });
    refused([](NormalModes& m) { m.stiffness[3] = std::nanf(""); });
    refused([](NormalModes& m) { m.y.pop_back(); });
    refused([](NormalModes& m) {
        m.stiffness.resize(21, 1e3F);
        m.x.resize(21 * m.nodes()), m.y.resize(21 * m.nodes()), m.z.resize(21 * m.nodes());
    });
}

}  // namespace
}  // namespace tact::prep_modes_test
