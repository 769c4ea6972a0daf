// What a structure needs to bend in the servo loop.
//
// Points   of every level move with the nearest residue; atoms with their own
// Links    between residues that follow each other along a chain, sorted by the second. Strain: the largest relative change of their
//          lengths. A change of the amplitudes changes it by at most the sum of strain_per_m times the changes
// Spring   of each mode: 3 times its stiffness relative to that of the middle mode. Not to the first: a single loose tail would make all others
//          stiff
// Frame    body, metres
// Thread   made off the servo thread, then immutable
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/structure.hpp"
#include "rt/force/docking/point_set.hpp"

namespace tact {

// A vector for each node.
struct NodeVectors {
    std::vector<float> x, y, z;
    void resize(std::size_t n) { x.resize(n), y.resize(n), z.resize(n); }
};

struct FlexibleParts {
    struct Link {
        std::uint32_t a, b;  // nodes
        Vec3 rest_m;         // from a to b
    };

    NormalModes modes;                             // count() 0: the structure is rigid
    std::vector<std::vector<std::uint32_t>> node;  // of each point of each level
    std::vector<Link> links;
    std::vector<double> spring;        // of each mode
    std::vector<double> strain_per_m;  // of each mode
    double shift_per_m = 0.0;          // largest displacement of a point per RMSD

    [[nodiscard]] bool bends() const { return modes.count() > 0; }
};

[[nodiscard]] FlexibleParts make_flexible_parts(const Structure& structure,
                                                const std::vector<PointSet>& levels, NormalModes modes);

}  // namespace tact
