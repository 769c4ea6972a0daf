// tact info of a docking scene: transform, map, bodies, and the force in formulas.
#include <nlohmann/json.hpp>

#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/docking/places.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/level_maps.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

// The force model as text and formulas; the letters stand for the numbers printed beside it.
constexpr const char* kDockingFormulas[] = {
    "x_world = world_per_model * (x_model - centre_model_m); axes parallel, metres",
    "rho(x) = tricubic B-spline through (value - background) / sigma at the voxels of the force map (see the "
    "note); values outside the box are 0",
    "the spline interpolates the map's values at the voxels and is twice continuously differentiable",
    "a body at (c, q) has its points at r_i = c + q * p_i; at the position in the file q is 1, c is "
    "file_place_com_model_m",
    "points: atom_points at fidelity 1 (w_i mass fractions), those of a codebook level at its fidelity; "
    "between two levels "
    "the forces of both are blended linearly",
    "rho of a codebook level is that of the map smoothed by the discrete Gaussian of standard deviation "
    "map_smoothing_a",
    "reduced correlation C = sum_i w_i rho(r_i), in sigma; the weights sum to 1",
    "force on the hand, world, N: F = energy_j_per_sigma / world_per_model * sum_i w_i grad rho(r_i), grad "
    "in sigma per model metre",
    "torque about c, world, N m: Q = energy_j_per_sigma * sum_i w_i (r_i - c) x grad rho(r_i)",
    "both are the negative gradient of the energy U = -energy_j_per_sigma * C over the hand's motion; "
    "--force-scale multiplies both",
    "option laplacian: rho is -s^2 Laplacian of (Gaussian * (value - background)), s = 0.225 * "
    "max(resolution, 20 angstrom), over a unit that gives the density's force range with the same gain",
    "option subtraction: the other bodies' simulated map (Gaussians of s = 0.225 * resolution, weight Z), "
    "scaled by least squares where it is above 5 % of its maximum, is subtracted from value, but not below "
    "the background",
    "option clash: U = F (sqrt(L^2 + D^2) - L) is added, D = world_per_model * depth of the overlap (soft "
    "maximum over atoms at the surface), F = 2 N, L = F / K, K such that seeded encounters stay below 300 "
    "N/m; F and K times the force scale",
    "option flexible: r_i = c + q * (p_i + sum_k a_k u_k,i) with the displacements u_k,i of the normal modes "
    "(section MODE), and U gets "
    "energy_j_per_sigma * B / 2 * sum_k 0.01 s_k a_k^2, s_k = 3 * stiffness / stiffness of the middle mode, "
    "B the largest second "
    "derivative of C by position; da_k/dt = -20/s / (B energy_j_per_sigma) * dU/da_k, at most 10 angstrom/s",
    "the device gets F and Q after the output chain (limits, slew, ramp-in); tact eval gives them before it",
};

// What the force sums at each level: {x, y, z, weight}, metres from the centre of mass.
json points_of(const PointsView& points) {
    json rows = json::array();
    for (std::size_t i = 0; i < points.size(); ++i)
        rows.push_back({points.x[i], points.y[i], points.z[i], points.weight[i]});
    return rows;
}

// The smoothed maps that the controller sums the levels in.
LevelMaps level_maps_of(const SceneFile& file, const Places& places, const std::vector<Codebook>& books) {
    const SceneMeta& m = places.meta();
    return make_level_maps(read_force_map_grid(file), m.map_background, m.map_sigma, m.resolution_m,
                           level_smoothings_m(places.structures(), books, m.resolution_m));
}

json vec3(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
json vec_a(const Vec3& v) { return vec3(v / kAngstromM); }

}  // namespace

json docking_info(const SceneFile& file) {
    const Places places(file);
    const SceneMeta& m = places.meta();
    const DensityGrid& g = places.grid();
    json bodies = json::array();
    std::vector<Codebook> books;
    for (std::uint32_t i = 0; i < m.body_count; ++i) books.push_back(read_codebook(file, i));
    const LevelMaps maps = level_maps_of(file, places, books);
    for (std::uint32_t i = 0; i < m.body_count; ++i) {
        const Structure& s = places.structures()[i];
        json levels = json::array();
        for (std::size_t l = 0; l < books[i].levels.size(); ++l) {
            const Codebook::Level& level = books[i].levels[l];
            levels.push_back(
                {{"vectors", level.size()},
                 {"edges", level.edges.size()},
                 {"rms_error_a", level.rms_error_m / kAngstromM},
                 {"fidelity", static_cast<double>(l) / static_cast<double>(books[i].levels.size())},
                 {"map_smoothing_a", maps.smoothing_m[maps.map_of[i][l]] / kAngstromM},
                 {"points", points_of(level.view())}});
        }
        bodies.push_back({{"name", s.name},
                          {"atoms", s.size()},
                          {"chains", s.chain_names.size()},
                          {"normal_modes", places.modes()[i].count()},
                          {"mass_u", s.mass_u},
                          {"file_place_com_model_m", vec3(s.home_com_model_m)},
                          {"file_place_quat_xyzw", {0, 0, 0, 1}},
                          {"codebook", levels},
                          {"atom_points", points_of({s.x_m, s.y_m, s.z_m, s.mass_fraction})}});
    }
    return {{"world_per_model", m.world_per_model},
            {"centre_model_m", {m.centre_model_m[0], m.centre_model_m[1], m.centre_model_m[2]}},
            {"energy_j_per_sigma", m.energy_j_per_sigma},
            {"force_n_per_sigma_per_model_m", m.energy_j_per_sigma / m.world_per_model},
            {"map",
             {{"size", {g.size[0], g.size[1], g.size[2]}},
              {"spacing_a", vec_a(g.spacing_m)},
              {"origin_a", vec_a(g.origin_m)},
              {"mean", m.map_mean},
              {"sigma", m.map_sigma},
              {"background", m.map_background},
              {"contour", m.contour},
              {"contour_sigma", (m.contour - m.map_mean) / m.map_sigma},
              {"resolution_a", m.resolution_m / kAngstromM}}},
            {"bodies", bodies},
            {"formulas", kDockingFormulas}};
}

}  // namespace tact::launch
