// The model of an empty hand: a pointer in the display, without force except for the workspace walls (rt/safety).
//
// Used for the second of two arms when only the first hand holds bodies.
// Thread  servo; TACT_RT
#pragma once

#include "rt/force/force_model.hpp"

namespace tact {

class PointerModel final : public ForceModel {
public:
    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override {
        return {.path = "pointer", .floor = 1.0F, .start = 1.0F, .slew_per_s = 1.0F, .haptic = true};
    }
    [[nodiscard]] std::uint32_t items(float /*fidelity*/) const noexcept TACT_RT override { return 0; }
    void reset(const ToolState& /*tool*/) noexcept TACT_RT override {}
    StepResult step(const ToolState& /*tool*/, const Budget& /*budget*/) noexcept TACT_RT override {
        return {};
    }
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override {
        ModelBodies none;
        none.active = ModelBodies::kNone;
        return none;
    }
};

}  // namespace tact
