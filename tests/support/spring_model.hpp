// A force model with a known force: a spring to a point, with faults and delays on demand.
#pragma once

#include <algorithm>
#include <limits>

#include "ipc/base/clock.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class SpringModel final : public ForceModel {
public:
    Vec3 rest_world_m{0.02, -0.01, 0.03};
    double stiffness_n_m = 40.0;
    double turn_stiffness_n_m = 0.02;
    bool not_a_number = false;
    ManualClock* clock = nullptr;  // a step then takes `cost` times the level
    Duration cost{0};
    Duration predicted = std::chrono::microseconds(300);  // cost at full level that predict() expects
    Duration foreseen{0};                                 // of a contact that may come, at every level
    bool keeps_sums = false;  // a step with a work fraction takes proportionally less
    double turn_s = 0.0;      // duration of its slow update times the level; 0: it has none
    int* destroyed = nullptr;
    int resets = 0;

    ~SpringModel() override {
        if (destroyed != nullptr) ++*destroyed;
    }
    [[nodiscard]] KnobSpec knob() const noexcept override {
        return {.path = "spring.force", .floor = 0.1F, .start = 1.0F, .slew_per_s = 1e9F, .haptic = true};
    }
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept override {
        return static_cast<std::uint32_t>(1000.0F * fidelity + 0.5F);
    }
    // The error falls from 1 N to 0.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept override {
        PathLoad load;
        load.cost_foreseen = foreseen;
        load.cost_predicted = Duration(static_cast<std::int64_t>(static_cast<double>(predicted.count()) *
                                                                 static_cast<double>(fidelity)));
        load.error = 1.0 - static_cast<double>(fidelity);
        load.items = items(fidelity);
        return load;
    }
    void reset(const ToolState&) noexcept override { ++resets; }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept override {
        place_ = tool.T_world_tool;
        fidelity_ = static_cast<double>(budget.fidelity);
        const double share =
            keeps_sums ? std::clamp(static_cast<double>(budget.work_fraction), 0.1, 1.0) : 1.0;
        if (clock != nullptr) {
            clock->advance(Duration(static_cast<std::int64_t>(static_cast<double>(cost.count()) * share *
                                                              static_cast<double>(budget.fidelity))));
        }
        StepResult result;
        result.load.recomputed_fraction = static_cast<float>(share);
        result.wrench_world.force_n = stiffness_n_m * (rest_world_m - tool.T_world_tool.p_m);
        result.wrench_world.torque_n_m = -turn_stiffness_n_m * rotation_vector_rad(tool.T_world_tool.q);
        if (not_a_number) result.wrench_world.force_n.y() = std::numeric_limits<double>::quiet_NaN();
        return result;
    }
    [[nodiscard]] ModelBodies bodies() const noexcept override {
        ModelBodies bodies;
        bodies.count = 1;
        bodies.T_model_body[0] = place_;
        bodies.id[0] = 1;
        return bodies;
    }

    [[nodiscard]] double slow_update_s() const noexcept override { return turn_s * fidelity_; }

private:
    Pose place_;
    double fidelity_ = 1.0;
};

}  // namespace tact
