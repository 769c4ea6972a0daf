// A potential field on a grid, rendered as the force on a charged ball: minus the gradient of the potential, averaged over
// the ball.
//
// Force    F_world = -gain * mean over the ball of grad(phi), with the gain of the scene (ipc/scene/field). A tricubic
//          B-spline (ipc/scene/density) interpolates the potential, so the force is continuous and, inside the box,
//          conservative.
// Knob     field.force: number of points of the ball at which the gradient is summed, 8 to 4096 in four levels, blended
//          linearly between levels. The floor of 8 points gives the right direction, but near a strong charge a coarse mean.
// Error    of a level: 1.25 times the largest difference from a sum over twice the points of the finest level, at 512
//          random positions (fixed seed) in the box
// Outside  the box the force fades to zero over four grid steps; the potential continues there with the slope at the faces
// Clutch   while it is held, the force fades out
// Thread   servo; TACT_RT. Construction takes tens of milliseconds and may allocate
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/field/field.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/force_fade.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class FieldModel final : public ForceModel {
public:
    static constexpr std::array<std::uint32_t, 4> kPoints{8, 64, 512, 4096};
    static constexpr double kFadeSteps = 4.0;  // grid steps outside of the box

    FieldModel(const SceneMeta& meta, const FieldMeta& field, const DensityGrid& grid);

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    void reset(const ToolState& tool) noexcept TACT_RT override;
    [[nodiscard]] ModelStiffness stiffness() const noexcept TACT_RT override {
        return {.force_n_m = field_.stiffness_n_m};
    }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;

private:
    struct Level {
        std::vector<float> x, y, z, weight;  // points relative to the ball's centre, model metres
        double error_n = 0.0;
    };
    struct Plan {
        std::size_t lower, upper;
        double blend;  // 0: the lower level alone
    };
    static Level ball(std::uint32_t points, double radius_m);
    [[nodiscard]] Plan plan(float fidelity) const noexcept TACT_RT;
    // Of the points from `first` on, with their weights.
    [[nodiscard]] Vec3 force_n(const Level& level, const Vec3& at_model_m,
                               std::size_t first = 0) const noexcept TACT_RT;
    [[nodiscard]] double inside(const Vec3& at_model_m) const noexcept TACT_RT;
    void measure_errors();

    SceneMeta meta_;
    FieldMeta field_;
    DensityMap map_;
    std::vector<Level> levels_;
    ForceFade fade_;
};

// Throws StartupError if the scene is not a field.
[[nodiscard]] std::unique_ptr<ForceModel> load_field_model(const SceneFile& scene);

}  // namespace tact
