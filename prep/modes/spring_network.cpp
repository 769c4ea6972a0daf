#include "prep/modes/spring_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace tact {
namespace {

constexpr double kShortestM = 1e-10;  // two nodes at one place do not hold infinitely
constexpr double kJointM =
    10e-10;  // springs that only join parts are at least as stiff as one of this length

double stiffness_of(double length_m) { return std::pow(kNeighbourM / std::max(length_m, kShortestM), 6.0); }

using Cell = std::tuple<long, long, long>;

Cell cell_of(const Vec3& p, double edge_m) {
    return {std::lround(std::floor(p.x() / edge_m)), std::lround(std::floor(p.y() / edge_m)),
            std::lround(std::floor(p.z() / edge_m))};
}

class Springs {
public:
    explicit Springs(const std::vector<Vec3>& nodes) : nodes_(nodes), root_(nodes.size()) {
        std::iota(root_.begin(), root_.end(), std::uint32_t{0});
    }

    void add(std::uint32_t a, std::uint32_t b, double least) {
        if (a == b) return;
        const double stiffness = std::max(stiffness_of((nodes_[a] - nodes_[b]).norm()), least);
        double& known = springs_[std::minmax(a, b)];
        known = std::max(known, stiffness);
        root_[part_of(a)] = part_of(b);
    }

    void within(double cutoff_m) {
        std::map<Cell, std::vector<std::uint32_t>> cells;
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) cells[cell_of(nodes_[i], cutoff_m)].push_back(i);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            const auto [x, y, z] = cell_of(nodes_[i], cutoff_m);
            for (long c = 0; c < 27; ++c) {
                const auto found = cells.find({x + c % 3 - 1, y + c / 3 % 3 - 1, z + c / 9 - 1});
                if (found == cells.end()) continue;
                for (const std::uint32_t j : found->second) {
                    if (j > i && (nodes_[i] - nodes_[j]).norm() <= cutoff_m) add(i, j, 0.0);
                }
            }
        }
    }

    // A gap in the chain ends what follows along it.
    void along(const std::vector<std::uint16_t>& chain, double most_m) {
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            for (std::uint32_t n = 0; n < kChain.size(); ++n) {
                const std::uint32_t j = i + n + 1;
                if (j >= nodes_.size() || chain[j] != chain[i] || (nodes_[j] - nodes_[j - 1]).norm() > most_m)
                    break;
                add(i, j, kChain[n]);
            }
        }
    }

    // From a node with few springs to its nearest nodes, whatever their distance.
    void hold_loose_nodes() {
        std::vector<std::size_t> count(nodes_.size(), 0);
        for (const auto& [ends, stiffness] : springs_) ++count[ends.first], ++count[ends.second];
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (count[i] >= kNearest) continue;
            for (const std::uint32_t j : nearest(i, [&](std::uint32_t other) { return other != i; }))
                add(i, j, stiffness_of(kJointM));
        }
    }

    void join_parts() {
        for (;;) {
            const std::uint32_t part = part_of(0);
            // The pairs of a node of this part and one of the others, nearest first.
            std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> pairs;
            for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
                if (part_of(i) != part) continue;
                const auto other = nearest(i, [&](std::uint32_t j) { return part_of(j) != part; });
                if (other.empty()) return;  // one part
                pairs.emplace_back((nodes_[i] - nodes_[other.front()]).norm(), i, other.front());
            }
            std::sort(pairs.begin(), pairs.end());
            pairs.resize(std::min(pairs.size(), kNearest));
            for (const auto& pair : pairs) {
                const std::uint32_t i = std::get<1>(pair), j = std::get<2>(pair);
                for (const std::uint32_t k :
                     nearest(j, [&](std::uint32_t n) { return part_of(n) == part_of(j); }))
                    joints_.emplace_back(i, k);
                joints_.emplace_back(i, j);
            }
            for (const auto& [i, j] : std::exchange(joints_, {})) add(i, j, stiffness_of(kJointM));
        }
    }

    [[nodiscard]] std::vector<Spring> take() const {
        std::vector<Spring> out;
        for (const auto& [ends, stiffness] : springs_) out.push_back({ends.first, ends.second, stiffness});
        return out;
    }

private:
    [[nodiscard]] std::uint32_t part_of(std::uint32_t i) {
        while (root_[i] != i) i = root_[i] = root_[root_[i]];
        return i;
    }

    // The nearest kNearest nodes that qualify, nearest first.
    template <class Qualifies>
    [[nodiscard]] std::vector<std::uint32_t> nearest(std::uint32_t i, const Qualifies& qualifies) {
        std::vector<std::pair<double, std::uint32_t>> found;
        for (std::uint32_t j = 0; j < nodes_.size(); ++j) {
            if (qualifies(j)) found.emplace_back((nodes_[i] - nodes_[j]).squaredNorm(), j);
        }
        const auto end = found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kNearest));
        std::partial_sort(found.begin(), end, found.end());
        std::vector<std::uint32_t> out;
        for (auto it = found.begin(); it != end; ++it) out.push_back(it->second);
        return out;
    }

    const std::vector<Vec3>& nodes_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> springs_;
    std::vector<std::uint32_t> root_;  // of each node's part
    std::vector<std::pair<std::uint32_t, std::uint32_t>> joints_;
};

}  // namespace

std::vector<Spring> make_springs(const std::vector<Vec3>& nodes_m, const std::vector<std::uint16_t>& chain,
                                 double cutoff_m, double scale) {
    Springs springs(nodes_m);
    springs.within(scale * cutoff_m);
    springs.along(chain, scale * kChainMostM);
    springs.hold_loose_nodes();
    if (!nodes_m.empty()) springs.join_parts();
    return springs.take();
}

}  // namespace tact
