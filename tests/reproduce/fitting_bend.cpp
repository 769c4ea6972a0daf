#include "tests/reproduce/fitting_bend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "hal/sim/sim_hand.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "prep/docking/bake_docking.hpp"
#include "prep/modes/elastic_network.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact::launch {
namespace {

constexpr std::size_t kModesBent = 6;
constexpr double kNeighboursM = 10.0 * kAngstromM;  // a larger gap: residues that the file lacks
constexpr Duration kBendStep = std::chrono::milliseconds(1);

std::array<float, kModesMax> random_bend(const NormalModes& modes, SeededRandom& random) {
    std::array<float, kModesMax> amplitude_m{};
    double square = 0.0;
    for (std::size_t k = 0; k < std::min<std::size_t>(kModesBent, modes.count()); ++k) {
        const double a = (2.0 * random.uniform() - 1.0) / std::sqrt(static_cast<double>(modes.stiffness[k]));
        amplitude_m[k] = static_cast<float>(a);
        square += a * a;
    }
    for (float& a : amplitude_m) a *= static_cast<float>(kBentM / std::max(std::sqrt(square), 1e-6));
    return amplitude_m;
}

Vec3 atom(const Structure& s, std::size_t i) {
    return Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>();
}

// The largest relative change of the distance of residues that follow each other in a chain.
double chain_strain(const Structure& straight, const Structure& bent, const NormalModes& modes) {
    struct Residue {
        Vec3 straight_m = Vec3::Zero(), bent_m = Vec3::Zero();
        double atoms = 0.0;
        std::uint16_t chain = 0;
    };
    std::vector<Residue> residues(modes.nodes());
    for (std::size_t i = 0; i < straight.size(); ++i) {
        Residue& r = residues[modes.node[i]];
        r.straight_m += atom(straight, i);
        r.bent_m += atom(bent, i);
        r.atoms += 1.0;
        r.chain = straight.chain[i];
    }
    double most = 0.0;
    for (std::size_t n = 1; n < residues.size(); ++n) {
        const Residue &a = residues[n - 1], &b = residues[n];
        const double rest_m = (b.straight_m / b.atoms - a.straight_m / a.atoms).norm();
        if (a.chain != b.chain || !(rest_m > 0.0) || rest_m > kNeighboursM) continue;
        most = std::max(most, std::abs((b.bent_m / b.atoms - a.bent_m / a.atoms).norm() / rest_m - 1.0));
    }
    return most;
}

DensityGrid map_of(const Structure& s) {
    Vec3 low = s.home() * atom(s, 0), high = low;
    for (std::size_t i = 0; i < s.size(); ++i) {
        low = low.cwiseMin(s.home() * atom(s, i));
        high = high.cwiseMax(s.home() * atom(s, i));
    }
    DensityGrid grid;
    grid.spacing_m = Vec3::Constant(0.25 * kBentResolutionM);
    grid.origin_m = low - Vec3::Constant(2.0 * kBentResolutionM);
    for (int a = 0; a < 3; ++a)
        grid.size[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(
            std::ceil((high[a] - low[a] + 4.0 * kBentResolutionM) / grid.spacing_m[a]));
    const PlacedStructure one[] = {{&s, s.home()}};
    grid.values = simulated_map(grid, one, kBentResolutionM);
    return grid;
}

}  // namespace

Bending bend_back(const Structure& structure, SeededRandom& random) {
    Bending found;
    const NormalModes modes = elastic_modes(structure, kBendModes);
    if (modes.count() == 0) return found;
    Structure answer = bent_structure(structure, modes, random_bend(modes, random));
    while (chain_strain(structure, answer, modes) > kTornStrain) {
        if (++found.torn == kDrawsMost) return found;
        answer = bent_structure(structure, modes, random_bend(modes, random));
    }
    DockingInput input;
    input.title = "bending";
    input.grid = map_of(answer);
    input.structures = {structure};
    input.resolution_m = kBentResolutionM;
    input.vertices_max = 1000;
    input.modes = kBendModes;
    SceneWriter out;
    bake_docking(input, out);
    const std::vector<std::byte> bytes = out.to_bytes();
    DockingSettings settings;
    settings.flexible = true;
    const auto model = load_docking_model(SceneFile::from_bytes(bytes, "bending"), settings);
    SimHand hand({}, Vec3::Constant(1.0));
    ToolState tool;
    tool.T_world_tool = hand.pose();
    model->reset(tool);
    for (int i = 0; i < static_cast<int>(kBendSeconds / to_s(kBendStep)); ++i) {
        tool.T_world_tool = hand.pose();
        tool.twist_world = hand.twist();
        hand.step(kBendStep, model->step(tool, Budget{}).wrench_world);
    }
    const Structure bent = bent_structure(structure, modes, model->flexible().shapes().front().amplitude_m);
    const Pose T_model_body = model->bodies().T_model_body[0];
    double square = 0.0;
    for (std::size_t i = 0; i < bent.size(); ++i)
        square += (T_model_body * atom(bent, i) - answer.home() * atom(answer, i)).squaredNorm();
    found.left_m = std::sqrt(square / static_cast<double>(bent.size()));
    return found;
}

}  // namespace tact::launch
