// A haptic model: pose and budget in, wrench out. It knows no device, topic or clock source.
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/knob.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

struct ToolState {
    Pose T_world_tool;
    Twist twist_world;
    std::uint32_t buttons = 0;  // bit 0: clutch (held: the tool moves alone)
};

enum class StepStatus : std::uint8_t { ok, out_of_time, out_of_range };

struct StepResult {
    Wrench wrench_world;  // at the tool's origin
    PathLoad load;        // error in newtons
    StepStatus status = StepStatus::ok;
};

// The bodies that a model moves, for those who draw or measure them.
struct ModelBodies {
    static constexpr std::size_t kMax = 16;
    std::uint32_t count = 0;
    std::uint32_t active = 0;
    std::array<Pose, kMax> T_model_body;
};

class ForceModel {  // constructed off the servo thread; construction may throw, steps may not
public:
    virtual ~ForceModel() = default;
    [[nodiscard]] virtual KnobSpec knob() const noexcept = 0;
    // Points, blocks or vertices felt at a level; the governor publishes it.
    [[nodiscard]] virtual std::uint32_t items(float fidelity) const noexcept = 0;
    virtual void reset(const ToolState& tool) noexcept TACT_RT = 0;  // the bodies stay where they are
    // Slow half, own thread, tens of hertz: prepares what the next steps will need.
    virtual void tend(const ToolState& /*predicted*/, const Budget& /*budget*/) noexcept {}
    // Fast half, every cycle. Out of time, it returns the best usable wrench found so far.
    virtual StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT = 0;
    [[nodiscard]] virtual ModelBodies bodies() const noexcept TACT_RT = 0;
};

}  // namespace tact
