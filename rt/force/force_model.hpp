// A haptic model: pose and budget in, wrench out. It depends on no device and no clock source.
//
// Topic    A model publishes data specific to its system in a topic of its own: publish().
// Bodies   Placed copies of the scene's structures, which the tool can grip. Orders change them in constant time at
//          a cycle boundary.
// Rebuild  Orders that need more than constant time (for example another density) make the model stale() until
//          rebuild() has made a new model on another thread and adopt() has replaced the old one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "ipc/base/knob.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

inline constexpr std::uint32_t kDriveButton = 1U << 1;  // drives the tool while held

struct ToolState {
    Pose T_world_tool;
    Twist twist_world;
    std::uint32_t buttons = 0;  // bit 0: clutch (held: the tool moves alone); kDriveButton
};

// Drive state of a tool during the next step.
struct ToolDrive {
    bool enabled = false;  // the force is on; tools run only then
    bool on = false;       // enabled, and the switch of this tool is on
    double step_s = 1e-3;  // time since the last step
};

enum class StepStatus : std::uint8_t { ok, out_of_time, out_of_range };

// Stiffness of what a model shows: the largest change of force per displacement and of torque per rotation of the tool, over
// all directions, in the world frame. 0: none, or unknown.
struct ModelStiffness {
    double force_n_m = 0.0;
    double torque_n_m_rad = 0.0;
};

struct StepResult {
    Wrench wrench_world;  // at the tool's origin
    PathLoad load;        // error in newtons
    StepStatus status = StepStatus::ok;
    std::uint32_t trace_flags = 0;  // model-specific bits 16 to 31 of TraceTopic::status
};

// The bodies of a model. A body keeps its id; its index in these lists changes when bodies are removed.
struct ModelBodies {
    static constexpr std::size_t kMax = 16;
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;  // value of active: no body held
    static constexpr std::uint16_t kFixed = 1U << 0;     // flag: the hand does not move the body
    std::uint32_t count = 0;
    std::uint32_t active = 0;  // index of the held body, or kNone
    std::array<Pose, kMax> T_model_body;
    std::array<std::uint32_t, kMax> id{};         // from 1, never reused
    std::array<std::uint16_t, kMax> structure{};  // index in the scene
    std::array<std::uint16_t, kMax> flags{};
    std::uint64_t grips = 0;       // increases when the tool grips a body (start of a gesture)
    std::uint64_t placements = 0;  // increases when an order places, adds or removes a body
    std::uint64_t others = 0;      // increases when a body other than the active one changes
    std::uint64_t tools = 0;  // increases when the tool is exchanged for one whose steps cost something else
    std::uint32_t options = 0;        // options in use; the model defines the bits
    std::uint32_t options_asked = 0;  // options ordered; they differ from options during a rebuild
    // Places found for the held body, the one that it leans to, and the size of the pull towards them.
    std::uint32_t places = 0, place = 0;
    double pull_n = 0.0;
};

// An order of the user.
struct ModelOrder {
    enum class Kind : std::uint8_t {
        select,   // grips the body; ModelBodies::kNone: releases
        fix,      // on: the hand neither moves the body nor feels it
        place,    // moves the body to T_model_body
        add,      // adds a copy of structure `body` at T_model_body, not gripped
        remove,   // removes the body, unless it is the last one
        setting,  // system-specific `command`, which defines the use of `body`, `value` and T_model_body.p_m
    };
    Kind kind = Kind::select;
    std::uint8_t command = 0;  // CommandKind
    bool on = false;           // value is not 0
    std::uint32_t body = 0;    // body id; for add: index of a structure
    double value = 0.0;
    Pose T_model_body;
};

// Period of a model's slow update.
inline constexpr Duration kSlowUpdatePeriod = std::chrono::milliseconds(4);
// Largest fraction of that period that an update may take before the level falls.
inline constexpr double kSlowUpdateFraction = 0.9;

// The servo cycle of which a model publishes.
struct ModelCycle {
    Instant now{};
    std::uint64_t cycle = 0;
    std::uint32_t hand = 0;  // index of the hand that holds the model's tool
    const StepResult& step;  // of this cycle
};

class ForceModel {  // constructed off the servo thread; construction may throw, steps may not
public:
    virtual ~ForceModel() = default;
    // The fidelity knob of the held body; its start level fits any budget.
    [[nodiscard]] virtual KnobSpec knob() const noexcept TACT_RT = 0;
    // Number of points, blocks or vertices that a level evaluates; the governor publishes it.
    [[nodiscard]] virtual std::uint32_t items(float fidelity) const noexcept TACT_RT = 0;
    // Predicts cost (cost_predicted), error and items of a full step at a level, for the body in the hand.
    // The cost may be off by a factor common to all levels: the governor measures that factor. A model that has met no
    // contact yet states in addition what one will cost (cost_foreseen). Constant time.
    [[nodiscard]] virtual PathLoad predict(float /*fidelity*/) const noexcept TACT_RT { return {}; }
    virtual void reset(const ToolState& tool) noexcept TACT_RT = 0;  // the bodies stay where they are
    // Stiffness that the next steps may show: an upper bound near the last pose. Constant time.
    [[nodiscard]] virtual ModelStiffness stiffness() const noexcept TACT_RT { return {}; }
    // True: the model needs slow_update(). Such a model stays until the run ends.
    [[nodiscard]] virtual bool has_slow_update() const noexcept { return false; }
    // Runs on a thread of its own at tens of hertz or more and prepares data for the next steps. Its timing may change
    // the duration of a step, never its force: a replay does not run it.
    virtual void slow_update(const ToolState& /*predicted*/, const Budget& /*budget*/) noexcept {}
    // Recent duration of a slow update, s; 0: none. If it exceeds its period, the level is too high.
    [[nodiscard]] virtual double slow_update_s() const noexcept TACT_RT { return 0.0; }
    // Before each step. An override calls this one too.
    virtual void drive(const ToolDrive& drive) noexcept TACT_RT { step_s_ = drive.step_s; }
    // Runs every cycle. Out of time, it returns the best usable wrench found so far.
    virtual StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT = 0;
    [[nodiscard]] virtual ModelBodies bodies() const noexcept TACT_RT = 0;
    // Publishes the model's own topic, once per cycle, after the force was sent. Models for which bodies and load
    // suffice have no topic.
    virtual void publish(const ModelCycle& /*cycle*/) noexcept TACT_RT {}

    // Constant time, between steps. No order causes a force step: the old force fades out, then the new one fades in
    // from zero. False: refused, nothing changed.
    virtual bool order(const ModelOrder& /*order*/) noexcept TACT_RT { return false; }
    // True: the force does not match the orders or the bodies; rebuild() is needed.
    [[nodiscard]] virtual bool stale() const noexcept TACT_RT { return false; }
    // Builds a model as ordered, for the given bodies. Runs off the servo thread, while steps and orders continue on
    // this model; may throw, and may take seconds. Null: nothing to build.
    [[nodiscard]] virtual std::unique_ptr<ForceModel> rebuild(const ModelBodies& /*bodies*/) const {
        return nullptr;
    }
    // Before the first step of a rebuilt model: takes over bodies, grip and later orders from the old model, and fades
    // out its force. False: old is of another kind; the caller must then reset() this model.
    virtual bool adopt(const ForceModel& /*old*/) noexcept TACT_RT { return false; }
    // rebuild() failed: reverts the order, so that stale() becomes false.
    virtual void give_up() noexcept TACT_RT {}

protected:
    // Length of the present step (s), as given to drive().
    [[nodiscard]] double step_s() const noexcept TACT_RT { return step_s_; }

private:
    double step_s_ = ToolDrive{}.step_s;
};

}  // namespace tact
