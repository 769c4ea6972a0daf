// Atomic structures: one BODY section each, and their codebooks, one CODE section each.
//
// Frame    body: origin at the centre of mass, axes as in the file, metres. home_com_model_m is the
//          position of that centre in the file, so the pose (home_com_model_m, identity) reproduces the
//          placement of the file
// Thread   created or read off the servo thread, then immutable
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct Structure {
    std::string name;  // of the source file
    Vec3 home_com_model_m = Vec3::Zero();
    double mass_u = 0.0;  // total
    // Per atom, in file order.
    std::vector<float> x_m, y_m, z_m;   // body frame
    std::vector<float> mass_fraction;   // sums to 1
    std::vector<std::uint8_t> element;  // atomic number, 0: unknown
    std::vector<std::uint16_t> chain;   // index into chain_names
    std::vector<std::int32_t> residue;  // sequence number
    std::vector<std::uint8_t> trace;    // 1: a C-alpha or nucleic P, drawn as the backbone
    std::vector<std::string> chain_names;

    [[nodiscard]] std::size_t size() const { return x_m.size(); }
    [[nodiscard]] Pose home() const { return {home_com_model_m, Quat::Identity()}; }
};

// Mass-weighted root mean square distance of the atoms from the centre of mass.
[[nodiscard]] double radius_of_gyration_m(const Structure& structure);

// Vector quantization of a structure: level l has points.size() vectors; sizes rise with l. The all-atom
// set is not stored; it is the level above the last. Small structures have no levels.
struct Codebook {
    struct Level {
        std::vector<float> x_m, y_m, z_m, weight;         // body frame; weights sum to 1
        std::vector<std::array<std::uint32_t, 2>> edges;  // competitive Hebbian graph
        double rms_error_m = 0.0;                         // quantization error
        [[nodiscard]] std::size_t size() const { return x_m.size(); }
        [[nodiscard]] PointsView view() const { return {x_m, y_m, z_m, weight}; }
    };
    std::vector<Level> levels;
};

void write_structure(SceneWriter& out, std::uint32_t index, const Structure& structure);
Structure read_structure(const SceneFile& file, std::uint32_t index);
void write_codebook(SceneWriter& out, std::uint32_t index, const Codebook& codebook);
Codebook read_codebook(const SceneFile& file, std::uint32_t index);

}  // namespace tact
