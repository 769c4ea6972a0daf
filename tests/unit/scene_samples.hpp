// Small valid pieces of a scene, for tests that break them one field at a time.
#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/support/error_of.hpp"

namespace tact::sample {

inline DensityGrid grid() {
    DensityGrid g;
    g.size = {5, 4, 3};
    g.origin_m = Vec3(-1e-9, 2e-9, 3e-9);
    g.spacing_m = Vec3(1e-10, 2e-10, 3e-10);
    for (std::size_t i = 0; i < g.count(); ++i) g.values.push_back(std::sin(static_cast<float>(i)));
    return g;
}

inline Structure structure() {
    Structure s;
    s.name = "three.pdb";
    s.home_com_model_m = Vec3(1e-9, -2e-9, 3e-9);
    s.mass_u = 40.0;
    s.x_m = {-1e-10F, 0.0F, 1e-10F};
    s.y_m = {0.0F, 2e-10F, -2e-10F};
    s.z_m = {3e-10F, 0.0F, -3e-10F};
    s.mass_fraction = {0.25F, 0.5F, 0.25F};
    s.element = {6, 7, 0};
    s.chain = {0, 0, 1};
    s.residue = {-3, 1, 2};
    s.trace = {1, 0, 1};
    s.chain_names = {"A", ""};
    return s;
}

inline Codebook codebook() {
    Codebook c;
    Codebook::Level one;
    one.x_m = one.y_m = one.z_m = {0.0F};
    one.weight = {1.0F};
    one.rms_error_m = 2e-10;
    Codebook::Level two;
    two.x_m = {-1e-10F, 1e-10F};
    two.y_m = {0.0F, 1e-11F};
    two.z_m = {2e-10F, -2e-10F};
    two.weight = {0.25F, 0.75F};
    two.edges = {{0, 1}};
    two.rms_error_m = 1e-10;
    c.levels = {one, two};
    return c;
}

inline SceneMeta meta() {
    SceneMeta m{};
    m.kind = SceneKind::docking;
    m.body_count = 1;
    m.world_per_model = 2e7;
    m.centre_model_m[1] = 1e-9;
    m.energy_j_per_sigma = 0.01;
    m.map_mean = 0.2;
    m.map_sigma = 0.5;
    m.map_background = -0.1;
    m.contour = 1.5;
    m.resolution_m = 12e-10;
    std::strcpy(m.title, "sample");
    return m;
}

inline SceneWriter scene(const SceneMeta& m = meta(), const Structure& s = structure(),
                         const Codebook& c = codebook(), const DensityGrid& g = grid(),
                         const std::string& note = "map: sample\n") {
    SceneWriter out;
    write_meta(out, m, note);
    write_grid(out, g);
    write_structure(out, 0, s);
    write_codebook(out, 0, c);
    return out;
}

}  // namespace tact::sample
