// Bone under a burr, for the tests of drilling.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/support/bone_block.hpp"

namespace tact::test {

inline constexpr double kDrilledVoxelM = 3e-4, kDrilledRadS = 6283.0;

// Bone below z = 0 of the world, under a tool without a shaft.
struct Drilled {
    BoneBlock bone;
    SceneMeta meta{};
    std::unique_ptr<DrillBone> shared;
    std::unique_ptr<DrillModel> model;

    explicit Drilled(double radius_m, std::uint32_t edge = 72, double rate_per_s = DrillSettings{}.rate_per_s)
        : bone(
              edge, kDrilledVoxelM, [=](const Vec3& p) { return p.z() < 0.5 * edge - 0.5 ? 1.0 : 0.0; }, 1) {
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        bone.bricks.origin_m = -kDrilledVoxelM * Vec3::Constant(0.5 * edge - 0.5);
        shared = std::make_unique<DrillBone>(bone.bricks, bone.density, bone.revision);
        DrillSettings s;
        s.burr_rad_s = kDrilledRadS;
        s.tool.radius_m = radius_m;
        s.tool.shaft_radius_m = 0.0;
        s.rate_per_s = rate_per_s;
        model = std::make_unique<DrillModel>(meta, *shared, s);
        model->turn_burr({kDrilledRadS, 1e-3});
    }
    StepResult step(const Vec3& p_m, float fidelity, const Deadline& deadline = {}) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        Budget budget;
        budget.fidelity = fidelity;
        budget.deadline = deadline;
        return model->step(tool, budget);
    }
    void begin(const Vec3& p_m) {
        ToolState tool;
        tool.T_world_tool.p_m = p_m;
        model->reset(tool);
        for (int i = 0; i < 400; ++i) (void)step(p_m, 1.0F);
    }
};

// To and fro by 4 mm, sinking to 1.5 mm in 0.3 s and then by 2 mm/s; above the bone at first.
inline Vec3 stroke_m(double radius_m, double t_s) {
    const double depth_m = t_s < 0.3 ? -1e-3 + t_s / 0.3 * 2.5e-3 : 1.5e-3 + 2e-3 * (t_s - 0.3);
    return {4e-3 * std::sin(12.0 * t_s), 1e-3 * std::sin(7.0 * t_s), radius_m - depth_m};
}

}  // namespace tact::test
