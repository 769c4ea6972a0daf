// A touched surface in the window: the tool, its contacts, and the detail around it.
//
// Thread   frame thread
#pragma once

#include <memory>

#include "gui/surface/detail_controller.hpp"
#include "gui/surface/surface_layer.hpp"
#include "gui/surface/surface_panels.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

class SurfaceSystem : public SceneSystem {
public:
    [[nodiscard]] SystemPanels& panels() override { return panels_; }
    void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
             SceneView& view, const SystemContext& context) override;
    void close() override;
    [[nodiscard]] std::optional<Vec3> tool_at(std::size_t hand, const SystemContext& context) const override;
    void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) override;
    [[nodiscard]] bool add_to_key(ContentKey& key) const override;

private:
    SurfacePanels panels_;
    std::shared_ptr<const SceneContent> content_;
    SceneView* view_ = nullptr;
    std::unique_ptr<SurfaceLayer> layer_;
    DetailController detail_;
};

}  // namespace tact
