#include "gui/field/field_content.hpp"

namespace tact {

FieldContent::FieldContent(const SceneFile& file)
    : field(read_field_meta(file)), map(read_grid(file), field.mean, field.deviation) {}

void FieldContent::each_point(const std::function<void(const Vec3&)>& take) const {
    take(Vec3(field.box_low_m));
    take(Vec3(field.box_high_m));
}

double FieldContent::potential(const Vec3& at_model_m, Vec3& gradient) const {
    const double value = map.sample(at_model_m, gradient);
    gradient *= field.deviation;
    return field.mean + field.deviation * value;
}

std::unique_ptr<SystemContent> read_field_content(SceneFile file, SceneContent& content) {
    auto own = std::make_unique<FieldContent>(file);
    content.box_min_model_m = Vec3(own->field.box_low_m);
    content.box_max_model_m = Vec3(own->field.box_high_m);
    return own;
}

}  // namespace tact
