// Makes the force model of a baked docking scene.
#include <string>

#include "ipc/base/error.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact {

std::unique_ptr<DockingModel> load_docking_model(const SceneFile& scene, const DockingSettings& settings) {
    const SceneMeta meta = read_meta(scene);
    if (meta.body_count == 0) {
        throw StartupError("loading '" + scene.name() + "'", "it is not a docking scene",
                           "bake one with tact-prep dock MAP MODEL -o SCENE");
    }
    std::vector<Structure> structures;
    std::vector<Codebook> codebooks;
    std::vector<NormalModes> modes;
    for (std::uint32_t i = 0; i < meta.body_count && i < ModelBodies::kMax; ++i) {
        structures.push_back(read_structure(scene, i));
        codebooks.push_back(read_codebook(scene, i));
        modes.push_back(read_modes(scene, i, structures.back()));
    }
    return std::make_unique<DockingModel>(meta, read_force_map_grid(scene), structures, codebooks, settings,
                                          modes);
}

}  // namespace tact
