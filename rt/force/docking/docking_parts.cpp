#include "rt/force/docking/docking_parts.hpp"

#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

namespace {

std::vector<PointSet> levels_of(const Structure& structure, const Codebook& codebook) {
    std::vector<PointSet> levels;
    std::size_t before = 0;
    for (const Codebook::Level& level : codebook.levels) {
        if (level.size() <= before || level.size() >= structure.size()) {
            throw StartupError("reading the codebook of '" + structure.name + "'",
                               "its levels do not ascend in size, or exceed the number of atoms",
                               "bake the scene again");
        }
        before = level.size();
        levels.push_back(make_point_set(level.view(), structure.name));
    }
    const PointsView atoms{structure.x_m, structure.y_m, structure.z_m, structure.mass_fraction};
    levels.push_back(make_point_set(atoms, structure.name));
    if (levels.front().size() > DockingParts::kAlways) {
        throw StartupError("reading the codebook of '" + structure.name + "'",
                           "it has no level of at most " + std::to_string(DockingParts::kAlways) +
                               " vectors, which must always fit",
                           "bake the scene again");
    }
    return levels;
}

}  // namespace

std::shared_ptr<const DockingParts> make_docking_parts(const SceneMeta& meta, const DensityGrid& grid,
                                                       const std::vector<Structure>& structures,
                                                       const std::vector<Codebook>& codebooks,
                                                       const std::vector<NormalModes>& modes) {
    const bool scale_good = std::isfinite(meta.world_per_model) && meta.world_per_model > 0.0;
    const bool gain_good = std::isfinite(meta.energy_j_per_sigma) && meta.energy_j_per_sigma >= 0.0;
    if (!scale_good || !gain_good) {
        throw StartupError("setting up docking", "the scene's scale or gain is not finite and positive",
                           "bake the scene again");
    }
    if (structures.empty() || structures.size() > ModelBodies::kMax ||
        structures.size() != codebooks.size()) {
        throw StartupError("setting up docking",
                           "the scene has " + std::to_string(structures.size()) + " structures and " +
                               std::to_string(codebooks.size()) + " codebooks",
                           "bake a scene of 1 to " + std::to_string(ModelBodies::kMax) + " structures");
    }
    const auto parts = std::make_shared<DockingParts>();
    parts->meta = meta;
    parts->grid = grid;
    parts->structures = structures;
    for (std::size_t i = 0; i < structures.size(); ++i) {
        if (!structures[i].home_com_model_m.allFinite()) {
            throw StartupError("setting up docking", "'" + structures[i].name + "' has no finite position",
                               "bake the scene again");
        }
        parts->levels.push_back(levels_of(structures[i], codebooks[i]));
        parts->flexible.push_back(make_flexible_parts(structures[i], parts->levels.back(),
                                                      i < modes.size() ? modes[i] : NormalModes{}));
        parts->clash.emplace_back(structures[i]);
        parts->gyration_m.push_back(radius_of_gyration_m(structures[i]));
    }
    parts->clash_gains = choose_clash_gains(parts->clash, meta.world_per_model);
    return parts;
}

}  // namespace tact
