#include "rt/servo/stage_model.hpp"

#include "rt/servo/rate_keeping.hpp"

namespace tact::servo {

namespace {

bool switched_on(const CycleState& c, const HandCycle& h, const ServoSettings& settings) noexcept {
    switch (h.drive.by) {
        case DriveSwitch::button:
            return (h.tool.buttons & kDriveButton) != 0;
        case DriveSwitch::line:
            return c.lines.fitted && c.lines.sample.sequence != 0 && c.lines.age <= settings.lines_age_max &&
                   (c.lines.sample.inputs & h.drive.line) != 0;
        case DriveSwitch::always:
            return true;
    }
    return false;
}

ToolDrive drive_of(const CycleState& c, const HandCycle& h, const ServoSettings& settings) noexcept {
    const bool enabled = c.run.state == RunState::active && !c.dry;
    return {.enabled = enabled, .on = enabled && switched_on(c, h, settings), .step_s = to_s(c.dt)};
}

}  // namespace

void step_models(CycleState& c, const ServoSettings& settings, const ServoIo& io) noexcept {
    const Instant begin = timestamp(c, io.clock);
    // Dry cycles have no deadline: they measure the cost of whole steps, and no hand is on the device.
    const bool limited = settings.model_deadline && !c.dry;
    const Instant end = limited ? begin + settings.model_max : Instant::max();
    c.budget = {.fidelity = io.script != nullptr ? io.script->level : c.governor.level(kForcePathIndex),
                .deadline = end,
                .work_fraction = static_cast<float>(work_fraction(c, settings))};
    c.recomputed_fraction = 0.0;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.model->drive(drive_of(c, h, settings));
        h.deadline = {};
        if (io.script != nullptr)
            h.deadline = {.checks = 0, .passed_at = io.script->deadline_check[i], .replayed = true};
        c.budget.deadline = Deadline(end, &h.deadline);
        h.step = h.model->step(h.tool, c.budget);
        c.recomputed_fraction += static_cast<double>(h.step.load.recomputed_fraction) / c.hands;
    }
    c.model_cost = timestamp(c, io.clock) - begin;
    c.deadline_missed = limited && c.model_cost > settings.model_max;
}

}  // namespace tact::servo
