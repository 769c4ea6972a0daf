#include "tests/reference/certify.hpp"

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

reference::Promises certify(const SceneFile& scene, const CertifySettings& settings) {
    reference::Promises promises;
    switch (read_meta(scene).kind) {
        case SceneKind::docking:
            certify_docking(scene, settings, promises);
            break;
        case SceneKind::surface:
            certify_surface(scene, settings, promises);
            break;
        case SceneKind::drilling:
            certify_drilling(scene, settings, promises);
            break;
        default:
            throw StartupError("certifying '" + scene.name() + "'", "scenes of this kind have no reference",
                               "choose a scene of docking, surface or drilling");
    }
    return promises;
}

}  // namespace tact
