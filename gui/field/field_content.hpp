// Content of a field scene besides its equipotential surfaces: the field's description and its potential anywhere.
#pragma once

#include <memory>

#include "gui/render/scene_content.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/field/field.hpp"

namespace tact {

class FieldContent : public SystemContent {
public:
    explicit FieldContent(const SceneFile& file);
    void each_point(const std::function<void(const Vec3&)>& take) const override;

    FieldMeta field;
    DensityMap map;

    // In the file's unit; `gradient` in that unit per model metre.
    [[nodiscard]] double potential(const Vec3& at_model_m, Vec3& gradient) const;
};

// Throws StartupError naming the file.
[[nodiscard]] std::unique_ptr<SystemContent> read_field_content(SceneFile file, SceneContent& content);

}  // namespace tact
