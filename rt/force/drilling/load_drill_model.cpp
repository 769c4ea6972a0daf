#include "ipc/assets/bone_volume.hpp"
#include "ipc/base/error.hpp"
#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

// There before the model that it is drilled by, and after it.
struct BoneMemory {
    explicit BoneMemory(const BoneVolumeView& volume)
        : density(volume.density.begin(), volume.density.end()),
          revision(volume.bricks.brick_count()),
          bone(volume.bricks, density, revision) {}
    std::vector<std::uint8_t> density;
    std::vector<std::uint32_t> revision;
    DrillBone bone;
};

class SceneDrill final : private BoneMemory, public DrillModel {
public:
    SceneDrill(const SceneMeta& meta, const BoneVolumeView& volume, const DrillSettings& settings)
        : BoneMemory(volume), DrillModel(meta, bone, settings) {}
};

}  // namespace

std::unique_ptr<ForceModel> load_drill_model(const SceneFile& scene, const DrillSettings& settings) {
    const SceneMeta meta = read_meta(scene);
    if (meta.kind != SceneKind::drilling)
        throw StartupError("loading '" + scene.name() + "'", "it has no bone to drill",
                           "bake one with tact-prep drill SCAN -o SCENE");
    return std::make_unique<SceneDrill>(meta, read_bone_volume(scene), settings);
}

}  // namespace tact
