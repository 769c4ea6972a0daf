#include "prep/export/bent_places.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <gemmi/elem.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/bonds.hpp"
#include "ipc/scene/density/vector_grid.hpp"

namespace tact {
namespace {

constexpr int kSweepsMax = 5000;

using Residue = std::pair<std::string, std::string>;  // chain and number, as in the file

std::uint8_t element_of(const FileAtom& a) {
    std::string symbol = a.element;
    if (symbol.empty()) {  // old PDB files: the first letter of the name
        const auto letter =
            std::find_if(a.name.begin(), a.name.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
        if (letter != a.name.end()) symbol = std::string(1, *letter);
    }
    return static_cast<std::uint8_t>(gemmi::Element(symbol).ordinal());
}

// Displacements of the atoms, ångström.
std::vector<Vec3> shifts_of(const std::vector<FileAtom>& atoms, const Structure& s, const NormalModes& modes,
                            std::span<const float> amplitude_m) {
    std::map<Residue, std::uint32_t> node_of;
    std::vector<Vec3> centre(modes.nodes(), Vec3::Zero());
    std::vector<double> count(modes.nodes(), 0.0);
    for (std::size_t i = 0; i < s.size(); ++i) {
        node_of.try_emplace({s.chain_names[s.chain[i]], std::to_string(s.residue[i])}, modes.node[i]);
        centre[modes.node[i]] +=
            (s.home_com_model_m + Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>()) / kAngstromM;
        count[modes.node[i]] += 1.0;
    }
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (std::size_t n = 0; n < centre.size(); ++n) {
        centre[n] /= count[n];
        low = low.cwiseMin(centre[n]);
        high = high.cwiseMax(centre[n]);
    }
    const VectorGrid near_nodes(centre, low, high);
    std::vector<Vec3> shifts;
    bool any = false;
    for (const FileAtom& a : atoms) {
        const auto known = node_of.find({a.chain, a.residue});
        any = any || known != node_of.end();
        std::array<VectorGrid::Near, 1> near{};
        if (known == node_of.end()) static_cast<void>(near_nodes.nearest(a.place_a, near));
        const std::size_t node = known == node_of.end() ? near[0].index : known->second;
        shifts.push_back(modes.shift_m(node, amplitude_m) / kAngstromM);
    }
    if (!any)
        throw StartupError("bend '" + s.name + "'", "no atom of the file is in a residue of the structure",
                           "bake the scene again from this file");
    return shifts;
}

// The atoms of one model, begin to end, as a structure about its first atom.
Structure model_of(const std::vector<FileAtom>& atoms, std::size_t begin, std::size_t end) {
    Structure s;
    std::map<std::string, std::uint16_t> chains;
    for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3f p = (kAngstromM * (atoms[i].place_a - atoms[begin].place_a)).cast<float>();
        s.x_m.push_back(p.x());
        s.y_m.push_back(p.y());
        s.z_m.push_back(p.z());
        s.element.push_back(element_of(atoms[i]));
        s.chain.push_back(
            chains.try_emplace(atoms[i].chain, static_cast<std::uint16_t>(chains.size())).first->second);
        s.residue.push_back(static_cast<std::int32_t>(std::strtol(atoms[i].residue.c_str(), nullptr, 10)));
    }
    return s;
}

struct Distance {
    std::size_t a, b;
    double length_a;
    bool bond;  // or over two bonds
};

// Over one and two bonds.
std::vector<Distance> distances_of(const std::vector<FileAtom>& atoms, std::size_t begin, std::size_t end) {
    const auto length = [&](std::size_t a, std::size_t b) {
        return (atoms[a].place_a - atoms[b].place_a).norm();
    };
    std::vector<Distance> out;
    std::vector<std::vector<std::size_t>> next(end - begin);
    for (const auto& [i, j] : find_bonds(model_of(atoms, begin, end))) {
        const std::size_t a = begin + i, b = begin + j;
        out.push_back({a, b, length(a, b), true});
        next[i].push_back(b);
        next[j].push_back(a);
    }
    for (const std::vector<std::size_t>& ends : next) {
        for (std::size_t i = 0; i < ends.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (ends[i] != ends[j]) out.push_back({ends[i], ends[j], length(ends[i], ends[j]), false});
            }
        }
    }
    return out;
}

double most_changed(const std::vector<Distance>& distances, const std::vector<Vec3>& at) {
    double most = 0.0;
    for (const Distance& d : distances) {
        if (d.bond) most = std::max(most, std::abs((at[d.a] - at[d.b]).norm() / d.length_a - 1.0));
    }
    return most;
}

void bring_back(const std::vector<Distance>& distances, std::vector<Vec3>& at) {
    for (int sweep = 0; sweep < kSweepsMax && most_changed(distances, at) > kBondMost; ++sweep) {
        for (const Distance& d : distances) {
            const Vec3 apart = at[d.b] - at[d.a];
            const double now = apart.norm();
            if (!(now > 1e-6)) continue;
            const Vec3 step = 0.5 * (now - d.length_a) / now * apart;
            at[d.a] += step;
            at[d.b] -= step;
        }
    }
}

}  // namespace

BentPlaces bent_places(const std::vector<FileAtom>& atoms, const Structure& structure,
                       const NormalModes& modes, std::span<const float> amplitude_m) {
    BentPlaces bent;
    const std::vector<Vec3> shifts = shifts_of(atoms, structure, modes, amplitude_m);
    for (std::size_t i = 0; i < atoms.size(); ++i) bent.at_a.push_back(atoms[i].place_a + shifts[i]);
    for (std::size_t begin = 0; begin < atoms.size();) {
        std::size_t end = begin + 1;
        while (end < atoms.size() && atoms[end].model == atoms[begin].model) ++end;
        const std::vector<Distance> distances = distances_of(atoms, begin, end);
        bent.bonds += static_cast<std::size_t>(
            std::count_if(distances.begin(), distances.end(), [](const Distance& d) { return d.bond; }));
        bent.bond_most_modes = std::max(bent.bond_most_modes, most_changed(distances, bent.at_a));
        bring_back(distances, bent.at_a);
        bent.bond_most = std::max(bent.bond_most, most_changed(distances, bent.at_a));
        begin = end;
    }
    double square = 0.0;
    for (std::size_t i = 0; i < atoms.size(); ++i) square += (bent.at_a[i] - atoms[i].place_a).squaredNorm();
    bent.rmsd_a = std::sqrt(square / static_cast<double>(std::max<std::size_t>(atoms.size(), 1)));
    return bent;
}

}  // namespace tact
