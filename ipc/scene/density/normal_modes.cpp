#include "ipc/scene/density/normal_modes.hpp"

#include <cmath>
#include <string>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kModeTag{'M', 'O', 'D', 'E'};
constexpr std::uint32_t kModeVersion = 1;
constexpr double kShiftMax = 1e4;        // of a node, per amplitude: one of a hundred million may move alone
constexpr float kStiffnessMax = 1e6F;    // relative to the softest mode
constexpr double kSizeTolerance = 1e-2;  // mean square displacement of a mode

}  // namespace

std::vector<std::uint32_t> residue_nodes(const Structure& structure) {
    std::vector<std::uint32_t> node(structure.size());
    for (std::size_t i = 1; i < structure.size(); ++i) {
        const bool same =
            structure.chain[i] == structure.chain[i - 1] && structure.residue[i] == structure.residue[i - 1];
        node[i] = node[i - 1] + (same ? 0U : 1U);
    }
    return node;
}

Structure bent_structure(const Structure& structure, const NormalModes& modes,
                         std::span<const float> amplitude_m) {
    Structure bent = structure;
    if (modes.count() == 0) return bent;
    std::vector<Eigen::Vector3f> shift;
    for (std::size_t n = 0; n < modes.nodes(); ++n)
        shift.push_back(modes.shift_m(n, amplitude_m).cast<float>());
    for (std::size_t i = 0; i < bent.size(); ++i) {
        bent.x_m[i] += shift[modes.node[i]].x();
        bent.y_m[i] += shift[modes.node[i]].y();
        bent.z_m[i] += shift[modes.node[i]].z();
    }
    return bent;
}

void write_modes(SceneWriter& out, std::uint32_t index, const NormalModes& modes) {
    BytesOut bytes;
    bytes.put(modes.count());
    bytes.put(static_cast<std::uint32_t>(modes.nodes()));
    bytes.put_all(modes.node);
    bytes.put_all(modes.stiffness);
    bytes.put_all(modes.x);
    bytes.put_all(modes.y);
    bytes.put_all(modes.z);
    out.add(kModeTag, kModeVersion, index, bytes.take());
}

NormalModes read_modes(const SceneFile& file, std::uint32_t index, const Structure& structure) {
    NormalModes modes;
    // A structure without modes has no section: sections are counted, so an empty one stands in its place.
    if (file.count(kModeTag) <= index) return modes;
    BytesIn in(file.section(kModeTag, kModeVersion, index),
               file.name() + ", section MODE " + std::to_string(index));
    const auto count = in.get<std::uint32_t>("number of modes");
    const auto nodes = in.get<std::uint32_t>("number of nodes");
    if (count > kModesMax)
        in.fail("it has " + std::to_string(count) + " modes, more than " + std::to_string(kModesMax));
    if (count == 0) {
        if (nodes != 0) in.fail("it has nodes but no modes");
        in.finish();
        return modes;
    }
    if (nodes == 0 || nodes > structure.size())
        in.fail("it has " + std::to_string(nodes) + " nodes for " + std::to_string(structure.size()) +
                " atoms");
    modes.node = in.get_all<std::uint32_t>(structure.size(), "node of each atom");
    modes.stiffness = in.get_all<float>(count, "stiffness");
    modes.x = in.get_all<float>(std::size_t{count} * nodes, "x");
    modes.y = in.get_all<float>(std::size_t{count} * nodes, "y");
    modes.z = in.get_all<float>(std::size_t{count} * nodes, "z");
    in.finish();
    for (std::size_t i = 0; i < modes.node.size(); ++i) {
        const std::uint32_t before = i == 0 ? 0U : modes.node[i - 1];
        const bool follows =
            i == 0 ? modes.node[i] == 0 : modes.node[i] == before || modes.node[i] == before + 1;
        if (!follows)
            in.fail("the node of atom " + std::to_string(i) + " does not follow that of the atom before it");
    }
    if (modes.nodes() != nodes)
        in.fail("its atoms have " + std::to_string(modes.nodes()) + " nodes, not " + std::to_string(nodes));
    for (std::size_t k = 0; k < count; ++k) {
        const float least = k == 0 ? 1.0F : modes.stiffness[k - 1];
        if (!(modes.stiffness[k] >= least && modes.stiffness[k] <= kStiffnessMax) ||
            (k == 0 && modes.stiffness[0] != 1.0F))
            in.fail("the stiffness of mode " + std::to_string(k) + " is " +
                    std::to_string(modes.stiffness[k]));
    }
    in.check_finite(modes.x, kShiftMax, "x of node");
    in.check_finite(modes.y, kShiftMax, "y of node");
    in.check_finite(modes.z, kShiftMax, "z of node");
    for (std::size_t k = 0; k < count; ++k) {
        double square = 0.0;
        for (std::size_t i = 0; i < structure.size(); ++i) {
            const std::size_t n = k * nodes + modes.node[i];
            square += static_cast<double>(structure.mass_fraction[i]) *
                      Eigen::Vector3f(modes.x[n], modes.y[n], modes.z[n]).cast<double>().squaredNorm();
        }
        if (!(std::abs(square - 1.0) <= kSizeTolerance))
            in.fail("the mean square displacement of mode " + std::to_string(k) + " is " +
                    std::to_string(square) + " instead of 1");
    }
    return modes;
}

}  // namespace tact
