// A haptic model: pose and budget in, wrench out. It knows no device, topic or clock source.
//
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

inline constexpr std::uint32_t kDrillPedal = 1U << 1;  // button: drives the tool while it is held

struct ToolState {
    Pose T_world_tool;
    Twist twist_world;
    std::uint32_t buttons = 0;  // bit 0: clutch (held: the tool moves alone); kDrillPedal
};

// What drives a tool that turns, and how long the next step stands for.
struct ToolDrive {
    double burr_rad_s = 0.0;  // about the shaft's axis; 0: it stands
    double step_s = 1e-3;     // since the step before
};

enum class StepStatus : std::uint8_t { ok, out_of_time, out_of_range };

struct StepResult {
    Wrench wrench_world;  // at the tool's origin
    PathLoad load;        // error in newtons
    StepStatus status = StepStatus::ok;
};

// What a force may be made of besides the bodies' own field. Bits; numbered as the topics number them.
enum ModelOption : std::uint32_t {
    kOptionClash = 1U << 0,        // bodies push each other apart
    kOptionSubtraction = 1U << 1,  // what the other bodies explain is taken away from the field
    kOptionLaplacian = 1U << 2,    // the Laplacian of the field is felt
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
    std::uint32_t options = 0;        // ModelOption, as felt now
    std::uint32_t options_asked = 0;  // and as ordered; they differ while a model is built aside
};

// How fine a model keeps a surface around the tool, of models that do. Model metres.
struct ModelDetail {
    bool there = false;
    bool full = false;                     // within the radius all is as in the full mesh
    double radius_m = 0.0;                 // of full detail
    std::uint8_t shape = 0;                // of the filter beyond it, numbered as FilterForm::Shape
    float width = 0.0F, error_far = 0.0F;  // of the filter, in radii
    double deviation_m = 0.0;              // of the surface beyond the radius from the full mesh, at the most
    std::uint32_t vertices = 0, triangles = 0;  // active
    std::uint32_t near_triangles = 0;           // expected around the tool
    double turn_s = 0.0,
           turn_predicted_s = 0.0;  // of the slow half; filtered, and as predicted for the level
};

// What a model that touches a surface shows of it. Model metres.
struct ModelTouch {
    static constexpr std::size_t kPlanesMax = 3;
    bool there = false;  // false: this model touches no surface, and the rest means nothing
    Vec3 probe_m = Vec3::Zero(), proxy_m = Vec3::Zero();
    double radius_m = 0.0;
    std::uint32_t planes = 0;             // that hold the proxy
    std::array<Vec3, kPlanesMax> normal;  // unit, towards the proxy
    std::array<double, kPlanesMax> push_n{};
    std::uint8_t state = 0;   // numbered as TouchState
    std::uint8_t regime = 0;  // numbered as TouchRegime
    ModelDetail detail;
};

// What a tool in bone shows of itself. World metres, but for its pose.
struct ModelDrill {
    bool there = false;      // false: this model is no such tool, and the rest means nothing
    bool cuts = false;       // a burr; else a tube
    std::uint8_t shape = 0;  // of a burr's head, numbered as DrillShape
    Pose T_model_tool;       // head's centre, shaft along +z
    double radius_m = 0.0, length_m = 0.0, tip_radius_m = 0.0, shaft_radius_m = 0.0, shaft_length_m = 0.0;
    double burr_rad_s = 0.0;
    double depth = 0.0;                                // h / R of the head
    double elastic_n = 0.0;                            // sum of sizes, before limits
    std::uint64_t removed_levels = 0, cut_levels = 0;  // since it was made, and in the last step
    double level_m3 = 0.0;                             // of solid bone in the world
};

// What a person asks of the bodies.
struct ModelOrder {
    enum class Kind : std::uint8_t {
        select,  // takes the body into the hand; ModelBodies::kNone: lets go
        fix,     // on: the hand does not move it, and feels nothing of it
        place,   // puts it at T_model_body
        add,     // a copy of structure `body`, at T_model_body, not in the hand
        remove,  // never the last one
        option,  // turns `option` on or off
        filter,  // of a surface kept fine around the tool: `shape`, `width`, `error_far`
    };
    Kind kind = Kind::select;
    bool on = false;
    std::uint32_t body = 0;    // an id; of add: index of a structure
    std::uint32_t option = 0;  // one ModelOption
    std::uint8_t shape = 0;    // as in ModelDetail
    float width = 0.0F, error_far = 0.0F;
    Pose T_model_body;
};

// Period of a model's slow update.
inline constexpr Duration kSlowUpdatePeriod = std::chrono::milliseconds(4);

class ForceModel {  // constructed off the servo thread; construction may throw, steps may not
public:
    virtual ~ForceModel() = default;
    // Of the body in the hand; start is a level that fits any budget.
    [[nodiscard]] virtual KnobSpec knob() const noexcept TACT_RT = 0;
    // Points, blocks or vertices felt at a level; the governor publishes it.
    [[nodiscard]] virtual std::uint32_t items(float fidelity) const noexcept TACT_RT = 0;
    virtual void reset(const ToolState& tool) noexcept TACT_RT = 0;  // the bodies stay where they are
    // The largest stiffness that the hand can meet in it, N/m; 0: nobody knows.
    [[nodiscard]] virtual double stiffness_n_m() const noexcept TACT_RT { return 0.0; }
    // True: tend() has something to do. Such a model stays until the run ends.
    [[nodiscard]] virtual bool has_slow_update() const noexcept { return false; }
    // Slow half, own thread, tens of hertz or more: prepares what the next steps will need. When its turns come
    // changes the time of a step and never its force: a replay has none.
    virtual void slow_update(const ToolState& /*predicted*/, const Budget& /*budget*/) noexcept {}
    // What a turn of it takes lately; 0: there is none. Where it takes longer than it has, the level is too high.
    [[nodiscard]] virtual double slow_update_s() const noexcept TACT_RT { return 0.0; }
    // Before a step, where the tool is driven; what is not finite or below zero is a tool that stands.
    virtual void drive(const ToolDrive& /*drive*/) noexcept TACT_RT {}
    // Fast half, every cycle. Out of time, it returns the best usable wrench found so far.
    virtual StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT = 0;
    [[nodiscard]] virtual ModelBodies bodies() const noexcept TACT_RT = 0;
    [[nodiscard]] virtual ModelTouch touch() const noexcept TACT_RT { return {}; }
    [[nodiscard]] virtual ModelDrill drill() const noexcept TACT_RT { return {}; }

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
};

}  // namespace tact
