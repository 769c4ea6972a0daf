// Normal modes of a structure: the ways in which it bends most easily. One optional MODE section per structure.
//
// Node      a residue: its atoms move together by the same displacement. Atoms outside of residues are nodes too
// Mode      displacement of every node. Modes are orthogonal, and orthogonal to all rigid motions, with the masses of the atoms as
//           weights; the mean square displacement of a mode of amplitude a is a^2. So the square root of the sum of squared
//           amplitudes is the RMSD (mass-weighted) of the bent structure to the straight one
// Stiffness of each mode, relative to the first, the softest: rises with the index
// Frame     body, metres; amplitudes in metres
// Source    prep/modes (an elastic network)
// Thread    created or read off the servo thread, then immutable
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

inline constexpr std::uint32_t kModesMax = 20;

struct NormalModes {
    std::vector<std::uint32_t> node;  // of each atom of the structure; rises from 0 without gaps
    std::vector<float> stiffness;     // of each mode; the first is 1
    // Displacement of node n in mode k per unit of amplitude: x[k * nodes() + n].
    std::vector<float> x, y, z;

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(stiffness.size()); }
    [[nodiscard]] std::size_t nodes() const { return node.empty() ? 0 : std::size_t{node.back()} + 1; }
    [[nodiscard]] Vec3 unit_shift(std::size_t mode, std::size_t at) const noexcept TACT_RT {
        const std::size_t i = mode * nodes() + at;
        return Eigen::Vector3f(x[i], y[i], z[i]).cast<double>();
    }
    // Displacement of a node in the body frame, metres. Modes beyond the amplitudes count as 0.
    [[nodiscard]] Vec3 shift_m(std::size_t at, std::span<const float> amplitude_m) const noexcept TACT_RT {
        Vec3 sum = Vec3::Zero();
        const std::size_t modes =
            stiffness.size() < amplitude_m.size() ? stiffness.size() : amplitude_m.size();
        for (std::size_t k = 0; k < modes; ++k)
            sum += static_cast<double>(amplitude_m[k]) * unit_shift(k, at);
        return sum;
    }
};

// The node of each atom: atoms that follow each other in the file and share chain and residue.
[[nodiscard]] std::vector<std::uint32_t> residue_nodes(const Structure& structure);

// The structure with its atoms displaced; its other members stay. Without amplitudes, or modes: as it is.
[[nodiscard]] Structure bent_structure(const Structure& structure, const NormalModes& modes,
                                       std::span<const float> amplitude_m);

void write_modes(SceneWriter& out, std::uint32_t index, const NormalModes& modes);
// Without the section: no modes. Checks it against the structure of the same index.
NormalModes read_modes(const SceneFile& file, std::uint32_t index, const Structure& structure);

}  // namespace tact
