// A haptic model: pose and budget in, wrench out. It knows no device and no clock source.
//
// Topic    what only one system has to show, the model publishes itself, in a topic of its own: publish().
// Bodies   what the tool takes hold of: placed copies of the scene's structures. Orders change them, in
//          constant time, at a cycle boundary.
// Rebuild  what an order asks for and no constant time can give (another density, say) is stale() until a
//          model made aside by rebuild() has taken over by adopt().
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "ipc/base/knob.hpp"
#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

inline constexpr std::uint32_t kDriveButton = 1U << 1;  // drives the tool while it is held

struct ToolState {
    Pose T_world_tool;
    Twist twist_world;
    std::uint32_t buttons = 0;  // bit 0: clutch (held: the tool moves alone); kDriveButton
};

// What drives the tool of a hand during the next step.
struct ToolDrive {
    bool enabled = false;  // the force is on; only then does anything run
    bool on = false;       // enabled, and the switch of this tool is on
    double step_s = 1e-3;  // since the step before
};

enum class StepStatus : std::uint8_t { ok, out_of_time, out_of_range };

struct StepResult {
    Wrench wrench_world;  // at the tool's origin
    PathLoad load;        // error in newtons
    StepStatus status = StepStatus::ok;
    std::uint32_t trace_flags = 0;  // of the model, as TraceTopic::status has them: bits 16 to 31
};

// The bodies of a model. An id stays with its body; its place in these lists does not, as bodies are removed.
struct ModelBodies {
    static constexpr std::size_t kMax = 16;
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;  // as active: the hand holds none
    static constexpr std::uint16_t kFixed = 1U << 0;     // as flag: the hand does not move it
    std::uint32_t count = 0;
    std::uint32_t active = 0;  // index of the one in the hand, or kNone
    std::array<Pose, kMax> T_model_body;
    std::array<std::uint32_t, kMax> id{};         // from 1, never used again
    std::array<std::uint16_t, kMax> structure{};  // index in the scene
    std::array<std::uint16_t, kMax> flags{};
    std::uint64_t grips = 0;          // rises whenever the tool takes hold: a gesture begins
    std::uint64_t placements = 0;     // rises whenever an order put a body somewhere, added or removed one
    std::uint64_t others = 0;         // rises whenever the bodies besides the active one changed
    std::uint32_t options = 0;        // as felt now, bits of the model's own numbering
    std::uint32_t options_asked = 0;  // and as ordered; they differ while a model is built aside
};

// What a person asks of the model.
struct ModelOrder {
    enum class Kind : std::uint8_t {
        select,  // takes the body into the hand; ModelBodies::kNone: lets go
        fix,     // on: the hand does not move it, and feels nothing of it
        place,   // puts it at T_model_body
        add,     // a copy of structure `body`, at T_model_body, not in the hand
        remove,  // never the last one
        setting,  // of one system: `command`, with `body`, `value` and T_model_body.p_m as that command has them
    };
    Kind kind = Kind::select;
    std::uint8_t command = 0;  // CommandKind
    bool on = false;           // value is not 0
    std::uint32_t body = 0;    // an id; of add: index of a structure
    double value = 0.0;
    Pose T_model_body;
};

// Period of a model's slow update.
inline constexpr Duration kSlowUpdatePeriod = std::chrono::milliseconds(4);

// A cycle of the servo loop, for what a model publishes of it.
struct ModelCycle {
    Instant now{};
    std::uint64_t cycle = 0;
    std::uint32_t hand = 0;  // that holds the model's tool
    const StepResult& step;  // of this cycle
};

class ForceModel {  // constructed off the servo thread; construction may throw, steps may not
public:
    virtual ~ForceModel() = default;
    // Of the body in the hand; start is a level that fits any budget.
    [[nodiscard]] virtual KnobSpec knob() const noexcept TACT_RT = 0;
    // Points, blocks or vertices felt at a level; the governor publishes it.
    [[nodiscard]] virtual std::uint32_t items(float fidelity) const noexcept TACT_RT = 0;
    // Cost (cost_predicted), error and items of a whole step at a level, for the body in the hand, before it is made.
    // The cost may be off by a factor common to all levels: the governor measures that factor. Constant time.
    [[nodiscard]] virtual PathLoad predict(float /*fidelity*/) const noexcept TACT_RT { return {}; }
    virtual void reset(const ToolState& tool) noexcept TACT_RT = 0;  // the bodies stay where they are
    // The largest stiffness that the hand can meet in it, N/m; 0: nobody knows.
    [[nodiscard]] virtual double stiffness_n_m() const noexcept TACT_RT { return 0.0; }
    // True: slow_update() has something to do. Such a model stays until the run ends.
    [[nodiscard]] virtual bool has_slow_update() const noexcept { return false; }
    // Slow half, own thread, tens of hertz or more: prepares what the next steps will need. When its turns come
    // changes the time of a step and never its force: a replay has none.
    virtual void slow_update(const ToolState& /*predicted*/, const Budget& /*budget*/) noexcept {}
    // What a turn of it takes lately; 0: there is none. Where it takes longer than it has, the level is too high.
    [[nodiscard]] virtual double slow_update_s() const noexcept TACT_RT { return 0.0; }
    // Before each step. A model that overrides it calls this one too.
    virtual void drive(const ToolDrive& drive) noexcept TACT_RT { step_s_ = drive.step_s; }
    // Fast half, every cycle. Out of time, it returns the best usable wrench found so far.
    virtual StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT = 0;
    [[nodiscard]] virtual ModelBodies bodies() const noexcept TACT_RT = 0;
    // Publishes the model's own topic, once a cycle, after the force was sent. A model of which nothing besides bodies
    // and load is shown has none.
    virtual void publish(const ModelCycle& /*cycle*/) noexcept TACT_RT {}

    // Constant time, between steps. No order makes the force step: what was felt fades out, and what is felt
    // from then on fades in from zero. False: refused, and nothing changed.
    virtual bool order(const ModelOrder& /*order*/) noexcept TACT_RT { return false; }
    // True: what is felt is not what was ordered, or no longer fits the bodies, and rebuild() makes it right.
    [[nodiscard]] virtual bool stale() const noexcept TACT_RT { return false; }
    // A model as ordered, for the bodies as they were. Off the servo thread, while steps and orders go on
    // here; may throw, and may take seconds. Null: there is nothing to build.
    [[nodiscard]] virtual std::unique_ptr<ForceModel> rebuild(const ModelBodies& /*bodies*/) const {
        return nullptr;
    }
    // Before the first step of a rebuilt model: takes over the bodies, the grip and the orders since, and
    // lets the old force fade. False: old is no model of this kind; reset() it then.
    virtual bool adopt(const ForceModel& /*old*/) noexcept TACT_RT { return false; }
    // rebuild() failed: takes back what was ordered, so that it is not asked for again.
    virtual void give_up() noexcept TACT_RT {}

protected:
    // Length of the step that is made, as drive() was told; what moves with time takes it from here.
    [[nodiscard]] double step_s() const noexcept TACT_RT { return step_s_; }

private:
    double step_s_ = ToolDrive{}.step_s;
};

}  // namespace tact
