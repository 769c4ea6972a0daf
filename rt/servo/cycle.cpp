#include "rt/servo/cycle.hpp"

#include <algorithm>
#include <stdexcept>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

ChainSettings for_device(ChainSettings chain, const DeviceInfo& info) {
    chain.force_n_max = std::min(chain.force_n_max, info.force_n_max);
    chain.torque_n_m_max = std::min(chain.torque_n_m_max, info.torque_n_m_max);
    chain.wall_stiffness_n_m = std::min(chain.wall_stiffness_n_m, info.stiffness_n_m_max);
    chain.force_n_continuous = info.force_n_continuous;
    chain.workspace_half_m = info.workspace_half_m;
    if (info.position_step_m > 0.0) chain.translation.position_step = info.position_step_m;
    return chain;
}

// The first visual path, the haptic one, then the other visual ones.
bool add_knobs(Governor& governor, std::span<const VisualPath> visual, const KnobSpec& haptic) {
    bool good =
        governor.add(visual.front().knob) == kDisplayPathIndex && governor.add(haptic) == kForcePathIndex;
    for (std::size_t i = 1; i < visual.size(); ++i)
        good = good && governor.add(visual[i].knob) == kForcePathIndex + i;
    return good;
}

GovernorSettings governor_settings(const ServoSettings& settings) {
    GovernorSettings s = settings.governor;
    s.free_running = settings.free_running;
    return s;
}

}  // namespace

CycleState::CycleState(const ServoSettings& settings, std::span<const HandParts> parts, Instant now_)
    : pacer(settings.period, now_), watchdogs(settings.watchdogs), governor(governor_settings(settings)) {
    if (parts.empty() || parts.size() > kHandsMax) throw std::logic_error("servo: one or two hands");
    if (settings.visual_paths.empty()) throw std::logic_error("servo: a scene has a visual path");
    hands = static_cast<std::uint32_t>(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        HandCycle& h = hand[i];
        h.device = parts[i].device;
        h.model = parts[i].model;
        h.drive = parts[i].drive;
        h.torque = parts[i].info.torque_n_m_max > 0.0;
        h.chain = OutputChain(for_device(settings.chain, parts[i].info));
    }
    housekeeping.gui_heartbeat_ns = -1;
    if (!add_knobs(governor, settings.visual_paths, hand[0].model->knob()))
        throw StartupError("the knobs of the scene", "the force model's knob is impossible",
                           "report this scene");
    const ModelBodies bodies = hand[0].model->bodies();
    if (bodies.active < bodies.count) mailbox.governed_structure = bodies.structure[bodies.active];
}

}  // namespace tact
