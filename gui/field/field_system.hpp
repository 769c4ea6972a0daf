// A potential field in the window: its equipotential surfaces, the tool in it, and the numbers at the tool.
//
// Thread   frame thread
#pragma once

#include <memory>

#include "gui/field/field_panels.hpp"
#include "gui/render/scene_layer.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

class FieldSystem : public SceneSystem {
public:
    [[nodiscard]] SystemPanels& panels() override { return panels_; }
    void use(const std::shared_ptr<const SceneContent>& content, std::unique_ptr<SceneStart> start,
             SceneView& view, const SystemContext& context) override;
    void close() override;
    void follow(const SystemContext& context) override;
    void prepare(std::int64_t now_ns, bool sharp, ViewFrame& frame, const SystemContext& context) override;
    // The hand is in the frame; nothing else moves.
    [[nodiscard]] bool add_to_key(ContentKey& key) const override {
        static_cast<void>(key);
        return true;
    }

private:
    FieldPanels panels_;
    std::shared_ptr<const SceneContent> content_;
};

}  // namespace tact
